//! Errors of reading and writing files.

use teeter_contact::ProblemError;

/// Why a file can't be read as a contact problem, or can't be written. Names are paths inside the
/// file; contacts count from 0.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FclibError {
    /// The file can't be opened, read or written.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// The bytes aren't HDF5, or use HDF5 features that aren't supported.
    #[error("not a readable HDF5 file: {reason}")]
    NotHdf5 {
        /// The message of the HDF5 reader.
        reason: String,
    },
    /// An HDF5 file without a contact problem.
    #[error("no contact problem: the file has no group /fclib_local")]
    NoProblem,
    /// A global problem (mass matrix and Jacobian); only local ones are read.
    #[error("a global problem (group /fclib_global); only local problems (/fclib_local: W, q, mu) are read")]
    GlobalProblem,
    /// A required part is missing.
    #[error("/{name} is missing")]
    Missing {
        /// Its path.
        name: String,
    },
    /// A part exists but can't be read.
    #[error("/{name} can't be read: {reason}")]
    Unreadable {
        /// Its path.
        name: String,
        /// The message of the HDF5 reader.
        reason: String,
    },
    /// A part has the wrong data type.
    #[error("/{name} contains {found}, but must contain {expected}")]
    Type {
        /// Its path.
        name: String,
        /// The data type found.
        found: String,
        /// The data type needed.
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
    /// A part claims a size implausible for its file; refused before memory is allocated.
    #[error("/{name} claims {bytes} bytes, in a file of {file} bytes: refused")]
    TooLarge {
        /// Its path.
        name: String,
        /// The size it claims in bytes (`u64::MAX` on overflow).
        bytes: u64,
        /// The size of the file in bytes.
        file: u64,
    },
    /// The dimension is neither 2 nor 3.
    #[error("/fclib_local/spacedim is {0}, but must be 2 or 3")]
    SpaceDimension(i64),
    /// A matrix storage that isn't part of the format.
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
        /// Index in the array.
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
        /// Index in the array.
        at: usize,
        /// The index.
        value: i64,
        /// Rows of the matrix.
        rows: usize,
        /// Where the entry belongs, such as `contact 3` or `a triplet of contact 3`.
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
    /// A problem that can't be stored in this format.
    #[error("can't be written: {reason}")]
    Unwritable {
        /// The reason.
        reason: String,
    },
    /// A negative number of guesses.
    #[error("/guesses/number_of_guesses is {0}")]
    Guesses(i64),
    /// The data were read but aren't a valid contact problem.
    #[error(transparent)]
    Problem(#[from] ProblemError),
}
