//! `teeter completions` and `teeter man`: what a shell and `man` know of the program, from the same
//! definitions as `--help`.

use crate::console::{Console, print_all};
use crate::run::Exit;
use clap::CommandFactory;
use clap_complete::Shell;
use std::io;
use std::path::Path;

/// Prints the completions of a shell.
pub(crate) fn completions(shell: Shell) -> Exit {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut crate::arguments::Arguments::command(), "teeter", &mut script);
    print_all(&String::from_utf8_lossy(&script))
}

/// Writes man pages of the program and of its commands to a folder.
pub(crate) fn man(folder: &Path) -> Exit {
    match write_pages(folder) {
        Ok(count) => {
            Console::new(false)
                .note(&format!("{count} pages in {0}; man {0}/teeter.1 shows the first", folder.display()));
            Exit::FinishedRun
        }
        Err(error) => {
            Console::new(false).error(&format!("error: can't write man pages to {}: {error}", folder.display()));
            Exit::Failed
        }
    }
}

fn write_pages(folder: &Path) -> io::Result<usize> {
    std::fs::create_dir_all(folder)?;
    let program = crate::arguments::Arguments::command();
    let mut pages = vec![("teeter".to_owned(), program.clone())];
    for command in program.get_subcommands().filter(|command| !command.is_hide_set()) {
        let name = format!("teeter-{}", command.get_name());
        // clap keeps names for the whole run of the program, as here.
        let page: &'static str = name.clone().leak();
        let typed = format!("teeter {}", command.get_name());
        // The version stands at the foot of the page; the option is the program's alone.
        let command = command.clone().name(page).bin_name(typed).version(env!("CARGO_PKG_VERSION"));
        pages.push((name, command.disable_version_flag(true)));
    }
    for (name, command) in &pages {
        let mut page = Vec::new();
        clap_mangen::Man::new(command.clone()).render(&mut page)?;
        std::fs::write(folder.join(format!("{name}.1")), page)?;
    }
    Ok(pages.len())
}
