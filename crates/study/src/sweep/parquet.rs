//! `results.parquet`: the table of a study with the types of its columns.
//!
//! It is made from `results.csv` and from nothing else, so that equal tables give equal files, however many shards they were put
//! together from. The table is read twice, a row group at a time.

use super::Sweep;
use super::find::COLUMNS;
use super::number::is_whole;
use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::{self, Read, Write};
use std::sync::Arc;
use teeter_scenario::keys::{Kind, PathTarget};

/// The key of the file's metadata under which the units are: a JSON object of the names of columns
/// and their units, in the notation of scenes.
const UNITS: &str = "units";
/// Most rows of a row group, and the bytes of its cells from which on it takes none: what is held in memory.
const ROWS: usize = 1 << 16;
const BYTES: usize = 1 << 22;

/// Why there is no Parquet file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ParquetTableError {
    /// The text is no table.
    #[error("the table can't be read: {0}")]
    Csv(#[from] csv::Error),
    /// It can't be encoded.
    #[error("the table can't be written as Parquet: {0}")]
    Parquet(#[from] ParquetError),
    /// The table can't be opened.
    #[error("the table can't be read: {0}")]
    Io(#[from] io::Error),
}

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellType {
    Whole,
    Double,
    Bool,
    Text,
}

impl CellType {
    /// The type of a column that is the same in every study; `None` for keys and outputs, whose cells
    /// decide.
    fn of_name(name: &str) -> Option<Self> {
        let [_, at_low, at_high, changes, runs] = COLUMNS;
        match name {
            "status" | "warnings" | "error" => Some(Self::Text),
            "case" | "unsolved_steps" => Some(Self::Whole),
            _ if name == changes || name == runs => Some(Self::Whole),
            _ if name == at_low || name == at_high => Some(Self::Bool),
            _ => None,
        }
    }

    /// The type of a column whose cells are of the type `seen`, and whole numbers if `whole`.
    fn of_column(name: &str, seen: Option<Self>, whole: bool, sweep: &Sweep) -> Self {
        let key = key_of(name, sweep);
        // An output is what it is by name only.
        let is_key = !sweep.outputs().iter().any(|output| output.name() == name);
        match Self::of_name(name).or(seen).unwrap_or(Self::Double) {
            Self::Double if whole && is_key && is_whole(key) => Self::Whole,
            found => found,
        }
    }

    /// Takes the weakest type that holds all cells seen so far; `None` before the first.
    fn widened(before: Option<Self>, cell: &str) -> Option<Self> {
        let own = match cell {
            "" => return before,
            "true" | "false" => Self::Bool,
            _ if number(cell).is_some() => Self::Double,
            _ => Self::Text,
        };
        Some(before.map_or(own, |before| if before == own { own } else { Self::Text }))
    }

    fn column(self, name: &str) -> Result<Type, ParquetError> {
        let (physical, logical) = match self {
            Self::Whole => (PhysicalType::INT64, None),
            Self::Double => (PhysicalType::DOUBLE, None),
            Self::Bool => (PhysicalType::BOOLEAN, None),
            Self::Text => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let builder = Type::primitive_type_builder(name, physical).with_logical_type(logical);
        builder.with_repetition(Repetition::OPTIONAL).build()
    }
}

/// A number as tables have it. Words such as `inf`, which Rust also reads, are words.
fn number(cell: &str) -> Option<f64> {
    let digits = cell.trim_start_matches(['-', '+']);
    if digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') { cell.parse().ok() } else { None }
}

/// Writes `results.parquet` to `out`; `open` opens `results.csv`, more than once.
///
/// `case`, numbers of steps, changes and runs are whole numbers, `find.at_low` and `find.at_high`
/// true or false, `status`, `warnings` and `error` texts. A key that takes whole numbers only has
/// whole numbers. A column of another key or an output holds doubles if each of its cells is a number,
/// true or false if each is one of these, else texts; an empty cell is null, a column without any cell
/// one of doubles. The metadata have the units of columns under `units`.
///
/// # Errors
/// If the text is no table.
pub fn parquet_table<R: Read>(
    open: impl Fn() -> io::Result<R>,
    sweep: &Sweep,
    out: impl Write + Send,
) -> Result<(), ParquetTableError> {
    let mut reader = csv::Reader::from_reader(open()?);
    let names: Vec<String> = reader.headers()?.iter().map(str::to_owned).collect();
    let mut seen: Vec<(Option<CellType>, bool)> = vec![(None, true); names.len()];
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record)? {
        seen.iter_mut().zip(&record).for_each(|((seen, whole), cell)| {
            *seen = CellType::widened(*seen, cell);
            *whole &= cell.is_empty() || cell.parse::<i64>().is_ok();
        });
    }
    let types: Vec<CellType> =
        names.iter().zip(seen).map(|(name, (seen, whole))| CellType::of_column(name, seen, whole, sweep)).collect();
    let fields: Result<Vec<_>, _> =
        names.iter().zip(&types).map(|(name, kind)| kind.column(name).map(Arc::new)).collect();
    let schema = Arc::new(Type::group_type_builder("study").with_fields(fields?).build()?);
    let units = names.iter().filter_map(|name| Some((name.clone(), unit(name, sweep)?.into())));
    let units = serde_json::Value::Object(units.collect()).to_string();
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(vec![KeyValue::new(UNITS.to_owned(), units)]))
        .build();
    let mut writer = SerializedFileWriter::new(out, schema, Arc::new(properties))?;
    let mut reader = csv::Reader::from_reader(open()?);
    let (mut rows, mut bytes) = (Vec::new(), 0);
    loop {
        let more = reader.read_record(&mut record)?;
        if more {
            bytes += record.as_slice().len();
            rows.push(record.clone());
        }
        if rows.len() == ROWS || bytes >= BYTES || (!more && !rows.is_empty()) {
            let mut group = writer.next_row_group()?;
            write_rows(&mut group, &rows, types.len())?;
            group.close()?;
            rows.clear();
            bytes = 0;
        }
        if !more {
            writer.close()?;
            return Ok(());
        }
    }
}

fn write_rows<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    rows: &[csv::StringRecord],
    columns: usize,
) -> Result<(), ParquetError> {
    for place in 0..columns {
        let Some(mut column) = group.next_column()? else { break };
        let cells = || rows.iter().map(|row| row.get(place).unwrap_or_default());
        match column.untyped() {
            ColumnWriter::Int64ColumnWriter(writer) => {
                let (values, levels) = present(cells().map(|cell| cell.parse().ok()));
                writer.write_batch(&values, Some(&levels), None)?;
            }
            ColumnWriter::DoubleColumnWriter(writer) => {
                let (values, levels) = present(cells().map(number));
                writer.write_batch(&values, Some(&levels), None)?;
            }
            ColumnWriter::BoolColumnWriter(writer) => {
                let (values, levels) = present(cells().map(yes_or_no));
                writer.write_batch(&values, Some(&levels), None)?;
            }
            ColumnWriter::ByteArrayColumnWriter(writer) => {
                let text = |cell: &str| (!cell.is_empty()).then(|| ByteArray::from(cell));
                let (values, levels) = present(cells().map(text));
                writer.write_batch(&values, Some(&levels), None)?;
            }
            _ => {}
        }
        column.close()?;
    }
    Ok(())
}

/// The values that are there, and for each row a level: 1 if it has one. Only values are written.
fn present<T>(cells: impl Iterator<Item = Option<T>>) -> (Vec<T>, Vec<i16>) {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    for cell in cells {
        levels.push(i16::from(cell.is_some()));
        values.extend(cell);
    }
    (values, levels)
}

fn yes_or_no(cell: &str) -> Option<bool> {
    match cell {
        "true" | "yes" => Some(true),
        "false" | "no" => Some(false),
        _ => None,
    }
}

/// The key whose values a column has: those beside the searched ones are of the same key.
fn key_of<'n>(name: &'n str, sweep: &'n Sweep) -> &'n str {
    match sweep.find() {
        Some(find) if name == COLUMNS[0] => find.key.as_str(),
        _ => name,
    }
}

/// The unit of a column, where it is known: that of a key, the searched one included, or of the
/// column of the trajectory that an output reduces.
fn unit(name: &str, sweep: &Sweep) -> Option<String> {
    let key = key_of(name, sweep);
    if let Some(output) = sweep.outputs().iter().find(|output| output.name() == name) {
        if output.spectrum_of().is_some() {
            return Some("m/s^2".to_owned());
        }
        return teeter_report::column_unit("trajectory.csv", output.column()?).map(str::to_owned);
    }
    match teeter_scenario::keys::find(key)? {
        PathTarget::Key(_, found) => match found.kind {
            Kind::Quantity(dimension, _) => Some(dimension.unit()),
            _ => None,
        },
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    const SWEEP: &str = "scene = \"s.toml\"\n[grid]\nblock.b.tilt = [\"1 deg\", \"2 deg\"]\n\
        time.scheme = [\"moreau-jean\"]\n[outputs]\nlargest = { max = \"b.vx\" }\nover = \"verdict.0.what\"\n";

    fn bytes_of(text: &str, sweep: &Sweep) -> Vec<u8> {
        let mut bytes = Vec::new();
        parquet_table(|| Ok(text.as_bytes()), sweep, &mut bytes).unwrap();
        bytes
    }

    fn fields(text: &str) -> (Vec<Vec<Field>>, String) {
        let sweep = Sweep::read(SWEEP, "sweep.toml", &|_, _| Ok(Vec::new())).unwrap();
        let bytes = bytes_of(text, &sweep);
        assert_eq!(bytes, bytes_of(text, &sweep));
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap();
        let units = metadata.iter().find(|entry| entry.key == UNITS).unwrap().value.clone().unwrap();
        let rows = reader.get_row_iter(None).unwrap();
        (rows.map(|row| row.unwrap().into_columns().into_iter().map(|(_, field)| field).collect()).collect(), units)
    }

    #[test]
    fn cells_come_back_with_their_types_and_empty_ones_as_null() {
        let text = "case,block.b.tilt,time.scheme,largest,over,flag,mixed,none,status,unsolved_steps,warnings,error\n\
            0,0.1,moreau-jean,2e-301,rests,true,1,,complete,0,scene stiff-step,\n\
            1,-0.2,moreau-jean,,rocks,,inf,,failed,3,,\"at 1, \"\"x\"\"\"\n";
        let (rows, units) = fields(text);
        let word = |text: &str| Field::Str(text.to_owned());
        let first = [
            Field::Long(0),
            Field::Double(0.1),
            word("moreau-jean"),
            Field::Double(2e-301),
            word("rests"),
            Field::Bool(true),
            word("1"),
            Field::Null,
            word("complete"),
            Field::Long(0),
            word("scene stiff-step"),
            Field::Null,
        ];
        assert_eq!(rows[0], first);
        assert_eq!((rows.len(), &rows[1][3], &rows[1][5]), (2, &Field::Null, &Field::Null));
        assert_eq!((&rows[1][6], &rows[1][11]), (&word("inf"), &word("at 1, \"x\"")));
        assert_eq!(units, "{\"block.b.tilt\":\"rad\",\"largest\":\"m/s\"}");
    }

    #[test]
    fn keys_that_take_whole_numbers_only_have_whole_numbers() {
        let sweep = "scene = \"s.toml\"\n[grid]\nbeam.b.elements = [10, 20]\ncontact.c.friction = [1, 2]\n[outputs]\nn = \"impact_count\"\n";
        let sweep = Sweep::read(sweep, "sweep.toml", &|_, _| Ok(Vec::new())).unwrap();
        let first = |cell: &str| {
            let text = format!("case,beam.b.elements,contact.c.friction,n,status\n0,{cell},1.0,3,complete\n");
            let reader = SerializedFileReader::new(bytes::Bytes::from(bytes_of(&text, &sweep))).unwrap();
            let row = reader.get_row_iter(None).unwrap().next().unwrap().unwrap();
            row.into_columns().into_iter().skip(1).take(3).map(|(_, field)| field).collect::<Vec<_>>()
        };
        assert_eq!(first("10"), [Field::Long(10), Field::Double(1.0), Field::Double(3.0)]);
        assert_eq!(first("2.5")[0], Field::Double(2.5), "a case that was refused");
    }

    #[test]
    fn row_groups_hold_all_rows_and_a_table_without_rows_is_one() {
        let header = "case,status\n";
        let text: String = (0..=ROWS).map(|k| format!("{k},complete\n")).collect();
        let (rows, _) = fields(&format!("{header}{text}"));
        assert_eq!((rows.len(), &rows[ROWS][0]), (ROWS + 1, &Field::Long(ROWS as i64)));
        assert!(fields(header).0.is_empty());
        // Rows of many bytes make more groups.
        let long = "x".repeat(BYTES / 4);
        let text: String = (0..10).map(|k| format!("{k},{long}\n")).collect();
        assert_eq!(fields(&format!("case,error\n{text}")).0.len(), 10);
    }
}
