//! Prints the rows of the same run as a native program, one a line.

use std::process::ExitCode;

fn main() -> ExitCode {
    match in_wasm::rows() {
        Ok(rows) => {
            for row in rows.chunks(in_wasm::COLUMNS) {
                let row: Vec<String> = row.iter().map(|x| format!("{x:e}")).collect();
                println!("{}", row.join(" "));
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
