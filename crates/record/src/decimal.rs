//! Tables of one column whose numbers have decimal commas: nothing in a row tells them from two columns.

/// Whether a text is one column of numbers with decimal commas, `0,25` in each row, rather than two columns separated by commas, the
/// first of which would be times. It is, if what stands before the commas doesn't ascend from row to row, as times do, or what stands
/// behind one has zeros in front, as whole numbers haven't. A first row that is no number is a heading; lines that start with `#` are
/// comments.
///
/// ```
/// assert!(teeter_record::has_decimal_commas("a\n0,5\n1,25\n0,75\n"));
/// assert!(teeter_record::has_decimal_commas("0,05\n1,5\n"));
/// // Perhaps times of 0, 1 and 2 s.
/// assert!(!teeter_record::has_decimal_commas("0,5\n1,3\n2,7\n"));
/// ```
#[must_use]
pub fn has_decimal_commas(text: &str) -> bool {
    let rows = text.lines().map(str::trim).filter(|row| !row.is_empty() && !row.starts_with('#'));
    let mut before: Option<i64> = None;
    let (mut first, mut decimal, mut ascends) = (true, false, true);
    for row in rows {
        let heading = std::mem::take(&mut first) && !row.starts_with(|c: char| c.is_ascii_digit() || "+-,".contains(c));
        if heading {
            continue;
        }
        let Some((whole, behind)) = row.split_once(',') else {
            // Whole numbers, and those with an exponent, have no comma.
            if row.parse::<f64>().is_err() || row.contains('.') {
                return false;
            }
            decimal = true;
            continue;
        };
        let digits = behind.split(['e', 'E']).next().unwrap_or_default();
        let is_number = !digits.is_empty()
            && digits.bytes().all(|c| c.is_ascii_digit())
            && format!("{whole}.{behind}").parse::<f64>().is_ok();
        let unsigned = whole.trim_start_matches(['+', '-']);
        if !is_number || !unsigned.bytes().all(|c| c.is_ascii_digit()) {
            return false;
        }
        decimal |= (digits.len() > 1 && digits.starts_with('0')) || unsigned.is_empty() || whole == "-0";
        let number = whole.parse().unwrap_or(i64::MAX);
        ascends &= before.is_none_or(|before| number > before);
        before = Some(number);
    }
    before.is_some() && (decimal || !ascends)
}

#[cfg(test)]
mod tests {
    use super::has_decimal_commas;

    #[test]
    fn a_record_of_one_column_may_have_decimal_commas() {
        let read = |text: &str| crate::Record::read_with_step(text, "r", Some(0.01));
        let record = read("a [g]\n0,5\n-0,25\n1,0\n").unwrap();
        assert_eq!((record.len(), record.dt()), (3, 0.01));
        assert!((record.accelerations()[1] + 0.25 * crate::STANDARD_GRAVITY).abs() < 1e-15);
        // Two columns stay two, which have no step besides.
        assert!(read("0,0.5\n1,0.3\n2,0.7\n").is_err() && read("0,5\n1,3\n2,7\n").is_err());
    }

    #[test]
    fn columns_with_decimal_commas_are_told_from_two_columns() {
        for column in
            ["0,5\n-1,25\n", "0,1\n0,2\n0,3", "# m/s2\na [g]\n\n1,0e-3\n0,5\n", "-0,5\n1,5\n", ",5\n1,5", "0\n1,5\n"]
        {
            assert!(has_decimal_commas(column), "{column:?}");
        }
        for other in [
            "",
            "a\n",
            "0.5\n1.5\n",
            "0,1\n1,2\n",
            "0,1.5\n0,2.5\n",
            "0.1,2\n0.1,3\n",
            "0,1,2\n0,1,3\n",
            "0;5\n0;6\n",
            "0, 1\n0, 2\n",
            "0,5\n0,x\n",
            "0,-1\n0,-2\n",
        ] {
            assert!(!has_decimal_commas(other), "{other:?}");
        }
    }
}
