//! What can be wrong with a file.

use teeter_contact::ProblemError;

/// Why a file isn't a contact problem that can be solved, or can't be written. Names are paths
/// inside the file; contacts count from 0.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FclibError {
    /// The file can't be opened, read or written.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// The bytes aren't HDF5, or not HDF5 that can be read.
    #[error("not a readable HDF5 file: {reason}")]
    NotHdf5 {
        /// What the HDF5 reader says.
        reason: String,
    },
    /// HDF5, but no contact problem.
    #[error("no contact problem: the file has no group /fclib_local")]
    NoProblem,
    /// A global problem (mass matrix and Jacobian); only local ones are read.
    #[error("a global problem (group /fclib_global); only local problems (/fclib_local: W, q, mu) are read")]
    GlobalProblem,
    /// A part that must be there.
    #[error("/{name} is missing")]
    Missing {
        /// Its path.
        name: String,
    },
    /// A part that is there, but can't be read.
    #[error("/{name} can't be read: {reason}")]
    Unreadable {
        /// Its path.
        name: String,
        /// What the HDF5 reader says.
        reason: String,
    },
    /// Data of another kind than needed.
    #[error("/{name} holds {found}, but must hold {expected}")]
    Type {
        /// Its path.
        name: String,
        /// The kind of data found.
        found: String,
        /// The kind of data needed.
        expected: &'static str,
    },
    /// A part with too few or too many numbers.
    #[error("/{name} has {found} entries, but needs {expected}")]
    Size {
        /// Its path.
        name: String,
        /// Entries found.
        found: u64,
        /// Entries needed (at least, for the arrays of W).
        expected: u64,
    },
    /// A part that claims more than its file can plausibly hold; refused before memory is taken for
    /// it.
    #[error("/{name} claims {bytes} bytes, in a file of {file} bytes: refused")]
    TooLarge {
        /// Its path.
        name: String,
        /// Bytes that it would take (`u64::MAX` if that overflows).
        bytes: u64,
        /// Bytes of the file.
        file: u64,
    },
    /// Neither 2 nor 3 dimensions.
    #[error("/fclib_local/spacedim is {0}, but must be 2 or 3")]
    SpaceDimension(i64),
    /// A matrix storage that fclib doesn't know.
    #[error("/fclib_local/W/nz is {0}, but must be -1 (columns), -2 (rows) or the number of triplets")]
    Storage(i64),
    /// A matrix that is not square, or of a negative size.
    #[error("W is {rows} x {columns}, but must be square")]
    NotSquare {
        /// `m`.
        rows: i64,
        /// `n`.
        columns: i64,
    },
    /// A size that isn't a whole number of contacts.
    #[error("W has {rows} rows, which isn't a multiple of spacedim = {dimension}")]
    NotWholeContacts {
        /// `m`.
        rows: i64,
        /// `spacedim`.
        dimension: usize,
    },
    /// A pointer array that doesn't ascend from 0.
    #[error("/fclib_local/W/p[{at}] is {value}, but must ascend from 0 (the one before it is {before})")]
    Pointer {
        /// Place in the array.
        at: usize,
        /// The pointer.
        value: i64,
        /// The pointer before it (0 for the first).
        before: i64,
    },
    /// A row or column index outside the matrix.
    #[error("/fclib_local/W/{array}[{at}] is {value}, outside a matrix of {rows} rows ({of})")]
    Index {
        /// `i` or `p`.
        array: &'static str,
        /// Place in the array.
        at: usize,
        /// The index.
        value: i64,
        /// Rows of the matrix.
        rows: usize,
        /// Where the entry belongs: `contact 3`, or `triplet` if both may be wrong.
        of: String,
    },
    /// Equality constraints beside the contacts.
    #[error("the problem has {0} equality constraints (R, V, s); only problems of contacts alone are supported")]
    EqualityConstraints(i64),
    /// A guess or a solution with a number that is not finite.
    #[error("/{name} of contact {contact} is {value}, but must be finite")]
    NotFinite {
        /// Its path.
        name: String,
        /// The contact.
        contact: usize,
        /// The number.
        value: f64,
    },
    /// A problem that this format can't hold.
    #[error("can't be written: {reason}")]
    Unwritable {
        /// Why.
        reason: String,
    },
    /// A negative number of guesses.
    #[error("/guesses/number_of_guesses is {0}")]
    Guesses(i64),
    /// The data are read, but no contact problem.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}
