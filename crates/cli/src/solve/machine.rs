//! The machine and date of a measurement.

use std::time::{SystemTime, UNIX_EPOCH};

/// The processor, as the system names it.
pub(super) fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
    model.map_or_else(|| "unknown".to_owned(), |(_, name)| name.trim().to_owned())
}

pub(super) fn cores() -> String {
    std::thread::available_parallelism().map_or_else(|_| "unknown".to_owned(), |cores| cores.to_string())
}

/// The command as given, with only the name of the program.
pub(super) fn command() -> String {
    let quoted = |argument: String| if argument.contains(' ') { format!("\"{argument}\"") } else { argument };
    let arguments = std::env::args().skip(1).map(quoted);
    std::iter::once("teeter".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// Today, in UTC, as 2026-01-31.
pub(super) fn date() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
    civil(seconds / 86_400)
}

/// The date a number of days after 1970-01-01, by eras of 400 years that begin in March.
fn civil(days: u64) -> String {
    let days = days + 719_468; // since 0000-03-01
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    format!("{:04}-{month:02}-{day:02}", year + era * 400 + next)
}

#[cfg(test)]
mod tests {
    use super::civil;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let dates = [0, 59, 11_016, 11_017, 20_778].map(civil);
        assert_eq!(dates, ["1970-01-01", "1970-03-01", "2000-02-29", "2000-03-01", "2026-11-21"]);
    }
}
