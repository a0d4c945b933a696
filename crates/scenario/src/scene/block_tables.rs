//! In which tables the motions of blocks are.

/// Most blocks that all have columns if the scene doesn't choose any: spreadsheets hold 16 384 columns, and each block has six.
const MOST_IN_COLUMNS: usize = 2000;

/// In which tables of a run the motions of blocks are.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum BlockTables {
    /// Each block has columns in `trajectory.csv`.
    #[default]
    Columns,
    /// These have, by their numbers, in ascending order; the others are in no table.
    Chosen(Vec<usize>),
    /// None has: `blocks.csv` has a row for each block at each time.
    Rows,
}

impl BlockTables {
    /// Those of a scene that chooses none of its so many blocks.
    #[must_use]
    pub fn of(blocks: usize) -> Self {
        if blocks > MOST_IN_COLUMNS { Self::Rows } else { Self::Columns }
    }

    /// The numbers of those of so many blocks that have columns.
    pub fn columns(&self, blocks: usize) -> impl Iterator<Item = usize> + '_ {
        let (all, chosen): (_, &[usize]) = match self {
            Self::Columns => (0..blocks, &[]),
            Self::Chosen(chosen) => (0..0, chosen),
            Self::Rows => (0..0, &[]),
        };
        all.chain(chosen.iter().copied())
    }

    /// Whether there is a `blocks.csv`.
    #[must_use]
    pub fn has_rows(&self) -> bool {
        *self == Self::Rows
    }
}
