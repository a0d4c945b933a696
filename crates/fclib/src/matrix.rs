//! Conversion of W between a file's sparse storage and blocks in memory.

use crate::FclibError;
use crate::store::Store;
use crate::write::{fit, integers, numbers};
use hdf5_pure::GroupBuilder;
use teeter_contact::{Block, BlockSparse};

/// One entry of the matrix.
struct Entry {
    row: u32,
    column: u32,
    value: f64,
}

/// Reads W with `rows` rows, a whole number of contacts. The caller has checked that the file
/// contains vectors of that length, so allocating memory for as many rows is safe.
pub(crate) fn read<const D: usize>(store: &Store, rows: usize) -> Result<BlockSparse<D>, FclibError> {
    let storage = store.integer("fclib_local/W/nz")?;
    let pointers = store.integers("fclib_local/W/p")?;
    let indices = store.integers("fclib_local/W/i")?;
    let values = store.numbers("fclib_local/W/x")?;
    let mut entries = match storage {
        -1 => compressed::<D>(rows, &pointers, &indices, &values, |outer, inner| (inner, outer))?,
        -2 => compressed::<D>(rows, &pointers, &indices, &values, |outer, inner| (outer, inner))?,
        count if count >= 0 => triplets::<D>(rows, count as u64, &pointers, &indices, &values)?,
        other => return Err(FclibError::Storage(other)),
    };
    // A stable sort, so that duplicate entries are added in the file's order.
    let block = |e: &Entry| (e.row as usize / D, e.column as usize / D);
    entries.sort_by_key(block);
    Ok(blocks(rows / D, &entries, block))
}

fn blocks<const D: usize>(
    contacts: usize,
    entries: &[Entry],
    block: impl Fn(&Entry) -> (usize, usize),
) -> BlockSparse<D> {
    let mut rows: Vec<Vec<(usize, Block<D>)>> = vec![Vec::new(); contacts];
    for group in entries.chunk_by(|a, b| block(a) == block(b)) {
        let (i, j) = block(&group[0]);
        let mut sum = Block::<D>::zeros();
        for e in group {
            let place = &mut sum[(e.row as usize % D, e.column as usize % D)];
            // The first value is assigned, not added: 0 + (-0) would lose the sign.
            *place = if place.to_bits() == 0 { e.value } else { *place + e.value };
        }
        if i == j || sum.iter().any(|c| c.to_bits() != 0) {
            rows[i].push((j, sum));
        }
    }
    for (i, row) in rows.iter_mut().enumerate() {
        if let Err(at) = row.binary_search_by_key(&i, |(j, _)| *j) {
            // An empty diagonal block is reported by the problem's own check.
            row.insert(at, (i, Block::zeros()));
        }
    }
    // Can't fail: by construction the rows ascend, lie inside the matrix and have their diagonals.
    BlockSparse::from_rows(&rows).unwrap_or_default()
}

/// Reads compressed columns or rows; `place` turns (outer, inner) into (row, column).
fn compressed<const D: usize>(
    rows: usize,
    pointers: &[i64],
    indices: &[i64],
    values: &[f64],
    place: impl Fn(usize, usize) -> (usize, usize),
) -> Result<Vec<Entry>, FclibError> {
    if pointers.len() != rows + 1 {
        return Err(size("p", pointers.len(), rows as u64 + 1));
    }
    let mut before = 0;
    for (at, &value) in pointers.iter().enumerate() {
        if value < before || (at == 0 && value != 0) {
            return Err(FclibError::Pointer { at, value, before });
        }
        before = value;
    }
    let stored = enough(before as u64, indices, values)?;
    let mut entries = Vec::with_capacity(stored);
    for outer in 0..rows {
        for k in pointers[outer] as usize..pointers[outer + 1] as usize {
            let inner = index("i", k, indices[k], rows, || format!("contact {}", outer / D))?;
            let (row, column) = place(outer, inner);
            entries.push(Entry { row: row as u32, column: column as u32, value: values[k] });
        }
    }
    Ok(entries)
}

fn triplets<const D: usize>(
    rows: usize,
    count: u64,
    columns: &[i64],
    indices: &[i64],
    values: &[f64],
) -> Result<Vec<Entry>, FclibError> {
    let stored = enough(count, indices, values)?;
    if columns.len() < stored {
        return Err(size("p", columns.len(), count));
    }
    let mut entries = Vec::with_capacity(stored);
    for k in 0..stored {
        let row = index("i", k, indices[k], rows, || "a triplet's row".to_owned())?;
        let column = index("p", k, columns[k], rows, || format!("a triplet of contact {}", row / D))?;
        entries.push(Entry { row: row as u32, column: column as u32, value: values[k] });
    }
    Ok(entries)
}

/// The number of stored entries, if the arrays have at least as many (they may be longer: `nzmax`).
fn enough(stored: u64, indices: &[i64], values: &[f64]) -> Result<usize, FclibError> {
    if (indices.len() as u64) < stored {
        return Err(size("i", indices.len(), stored));
    }
    if (values.len() as u64) < stored {
        return Err(size("x", values.len(), stored));
    }
    Ok(stored as usize)
}

fn index(
    array: &'static str,
    at: usize,
    value: i64,
    rows: usize,
    of: impl Fn() -> String,
) -> Result<usize, FclibError> {
    match usize::try_from(value) {
        Ok(index) if index < rows => Ok(index),
        _ => Err(FclibError::Index { array, at, value, rows, of: of() }),
    }
}

fn size(array: &str, found: usize, expected: u64) -> FclibError {
    FclibError::Size { name: format!("fclib_local/W/{array}"), found: found as u64, expected }
}

/// Writes W in compressed columns, rows ascending, without zeros.
pub(crate) fn write<const D: usize>(h: &BlockSparse<D>, group: &mut GroupBuilder) -> Result<(), FclibError> {
    let size = fit("fclib_local/W/m", D * h.contacts())?;
    let entries = || {
        (0..h.contacts()).flat_map(|i| {
            (0..D).flat_map(move |r| {
                h.row(i).flat_map(move |(j, block)| (0..D).map(move |c| (D * i + r, D * j + c, block[(r, c)])))
            })
        })
    };
    let stored = || entries().filter(|(_, _, value)| value.to_bits() != 0);
    // Entries are counted first to get the column pointers, then stored row by row, so that rows
    // ascend within each column.
    let mut pointers = vec![0_usize; D * h.contacts() + 1];
    stored().for_each(|(_, column, _)| pointers[column + 1] += 1);
    for k in 1..pointers.len() {
        pointers[k] += pointers[k - 1];
    }
    let count = pointers.last().copied().unwrap_or(0);
    let nonzeros = fit("fclib_local/W/x", count)?;
    let mut next = pointers.clone();
    let (mut indices, mut values) = (vec![0_i32; count], vec![0.0; count]);
    for (row, column, value) in stored() {
        let at = next[column];
        next[column] += 1;
        // `size` and `count` fit into 32 bits, so all smaller numbers do too.
        (indices[at], values[at]) = (row as i32, value);
    }
    let pointers: Vec<i32> = pointers.iter().map(|&p| p as i32).collect();
    for (name, value) in [("nzmax", nonzeros), ("m", size), ("n", size), ("nz", -1)] {
        integers(group, name, &[value]);
    }
    integers(group, "p", &pointers);
    integers(group, "i", &indices);
    numbers(group, "x", &values);
    Ok(())
}
