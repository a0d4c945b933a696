//! Typed access to the parts of an HDF5 file; sizes are checked before anything is read.

use crate::FclibError;
use hdf5_pure::{DType, Dataset, Error, File, FormatError};

/// A part of up to this many bytes is always accepted …
const ALWAYS: u64 = 16 << 20;
/// … and a larger one up to this many times the file's size: compressed numbers stay below this
/// ratio, a decompression bomb doesn't.
const RATIO: u64 = 100;

/// An open file.
pub(crate) struct Store {
    file: File,
    bytes: u64,
}

impl Store {
    pub(crate) fn open(bytes: Vec<u8>) -> Result<Self, FclibError> {
        let length = bytes.len() as u64;
        let file = File::from_bytes(bytes).map_err(|error| FclibError::NotHdf5 { reason: error.to_string() })?;
        Ok(Self { file, bytes: length })
    }

    /// Whether there is a group of that name.
    pub(crate) fn has_group(&self, name: &str) -> Result<bool, FclibError> {
        match self.file.group(name) {
            Ok(_) => Ok(true),
            Err(Error::Format(FormatError::PathNotFound(_))) => Ok(false),
            Err(error) => Err(unreadable(name, &error)),
        }
    }

    /// A single integer, from a dataset of any shape.
    pub(crate) fn integer(&self, name: &str) -> Result<i64, FclibError> {
        let values = self.integers(name)?;
        match values.as_slice() {
            [value] => Ok(*value),
            _ => Err(FclibError::Size { name: name.to_owned(), found: values.len() as u64, expected: 1 }),
        }
    }

    pub(crate) fn integers(&self, name: &str) -> Result<Vec<i64>, FclibError> {
        let dataset = self.required(name)?;
        let dtype = dataset.dtype().map_err(|error| unreadable(name, &error))?;
        if !is_integer(&dtype) {
            return Err(wrong_type(name, &dtype, "integers"));
        }
        self.checked_length(&dataset, name)?;
        dataset.read_i64().map_err(|error| unreadable(name, &error))
    }

    /// Numbers; `None` if the part doesn't exist.
    pub(crate) fn numbers_if_any(&self, name: &str) -> Result<Option<Vec<f64>>, FclibError> {
        let Some(dataset) = self.find(name)? else { return Ok(None) };
        let dtype = dataset.dtype().map_err(|error| unreadable(name, &error))?;
        if !(matches!(dtype, DType::F32 | DType::F64) || is_integer(&dtype)) {
            return Err(wrong_type(name, &dtype, "numbers"));
        }
        self.checked_length(&dataset, name)?;
        dataset.read_f64().map(Some).map_err(|error| unreadable(name, &error))
    }

    pub(crate) fn numbers(&self, name: &str) -> Result<Vec<f64>, FclibError> {
        self.numbers_if_any(name)?.ok_or_else(|| FclibError::Missing { name: name.to_owned() })
    }

    /// A text; `None` if the part doesn't exist.
    pub(crate) fn text_if_any(&self, name: &str) -> Result<Option<String>, FclibError> {
        let Some(dataset) = self.find(name)? else { return Ok(None) };
        let dtype = dataset.dtype().map_err(|error| unreadable(name, &error))?;
        if !matches!(dtype, DType::String | DType::VariableLengthString) {
            return Err(wrong_type(name, &dtype, "a string"));
        }
        self.checked_length(&dataset, name)?;
        let texts = dataset.read_string().map_err(|error| unreadable(name, &error))?;
        // Up to the first NUL, as in C.
        let text = texts.first().and_then(|text| text.split('\0').next()).unwrap_or_default();
        Ok(Some(text.to_owned()))
    }

    fn find(&self, name: &str) -> Result<Option<Dataset>, FclibError> {
        match self.file.dataset(name) {
            Ok(dataset) => Ok(Some(dataset)),
            Err(Error::Format(FormatError::PathNotFound(_))) => Ok(None),
            Err(error) => Err(unreadable(name, &error)),
        }
    }

    fn required(&self, name: &str) -> Result<Dataset, FclibError> {
        self.find(name)?.ok_or_else(|| FclibError::Missing { name: name.to_owned() })
    }

    /// Refuses a part whose claimed size is implausible for the file. This holds for the whole part
    /// and for each of its chunks, which are decompressed as a whole.
    fn checked_length(&self, dataset: &Dataset, name: &str) -> Result<(), FclibError> {
        let shape = dataset.shape().map_err(|error| unreadable(name, &error))?;
        let chunk = dataset.chunk_shape().map_err(|error| unreadable(name, &error))?.unwrap_or_default();
        let element = dataset.element_size().map_err(|error| unreadable(name, &error))?;
        let allowed = ALWAYS.max(self.bytes.saturating_mul(RATIO));
        for extents in [shape, chunk] {
            // Numbers are converted to 8 bytes when read.
            let bytes = extents.iter().try_fold(element.max(8), |bytes, &extent| bytes.checked_mul(extent));
            let bytes = bytes.unwrap_or(u64::MAX);
            if bytes > allowed {
                return Err(FclibError::TooLarge { name: name.to_owned(), bytes, file: self.bytes });
            }
        }
        Ok(())
    }
}

fn is_integer(dtype: &DType) -> bool {
    use DType::{I8, I16, I32, I64, U8, U16, U32, U64};
    matches!(dtype, I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64)
}

fn unreadable(name: &str, error: &Error) -> FclibError {
    FclibError::Unreadable { name: name.to_owned(), reason: error.to_string() }
}

fn wrong_type(name: &str, found: &DType, expected: &'static str) -> FclibError {
    FclibError::Type { name: name.to_owned(), found: found.to_string(), expected }
}
