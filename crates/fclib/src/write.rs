//! Writing a problem to a file.

use crate::{FclibError, FclibProblem, LocalProblem, Solution, matrix};
use hdf5_pure::{CharacterSet, Datatype, FileBuilder, GroupBuilder, LibVer, StringPadding};
use std::path::Path;
use teeter_contact::Vector;

impl FclibProblem {
    /// The content of a file.
    ///
    /// # Errors
    /// As [`LocalProblem::to_bytes`].
    pub fn to_bytes(&self) -> Result<Vec<u8>, FclibError> {
        match self {
            Self::Plane(local) => local.to_bytes(),
            Self::Space(local) => local.to_bytes(),
        }
    }

    /// Writes a file, replacing an existing one.
    ///
    /// # Errors
    /// As [`LocalProblem::write`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), FclibError> {
        Ok(std::fs::write(path, self.to_bytes()?)?)
    }
}

impl<const D: usize> LocalProblem<D> {
    /// Writes a file, replacing an existing one.
    ///
    /// # Errors
    /// As [`LocalProblem::to_bytes`], or if the file can't be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), FclibError> {
        Ok(std::fs::write(path, self.to_bytes()?)?)
    }

    /// The content of a file. Reading it returns the same numbers and texts, bit for bit. W is
    /// stored in compressed columns, rows ascending, without zeros; an off-diagonal block of zeros
    /// is therefore missing when the file is read.
    ///
    /// The file has the HDF5 1.8 format, uncompressed, with contiguous arrays: libfclib, Siconos
    /// and h5py read it.
    ///
    /// # Errors
    /// If the data aren't a valid contact problem (sizes, finiteness, μ, H_NN), a guess or a
    /// solution has another size or isn't finite, a text contains the character NUL, or a size
    /// exceeds the format's 32 bits.
    pub fn to_bytes(&self) -> Result<Vec<u8>, FclibError> {
        if D != 2 && D != 3 {
            return Err(FclibError::SpaceDimension(D as i64));
        }
        self.problem()?;
        let mut file = FileBuilder::new();
        file.with_libver_bounds(LibVer::Earliest, LibVer::V18);
        let mut local = file.create_group("fclib_local");
        integers(&mut local, "spacedim", &[D as i32]);
        let mut w = local.create_group("W");
        matrix::write(&self.h, &mut w)?;
        local.add_group(w.finish());
        let mut vectors = local.create_group("vectors");
        numbers(&mut vectors, "q", &flat(&self.q));
        numbers(&mut vectors, "mu", &self.mu);
        local.add_group(vectors.finish());
        let mut info = local.create_group("info");
        let texts =
            [("title", &self.info.title), ("description", &self.info.description), ("math_info", &self.info.math_info)];
        for (name, value) in texts {
            if let Some(value) = value {
                text(&mut info, name, value)?;
            }
        }
        local.add_group(info.finish());
        file.add_group(local.finish());

        if !self.guesses.is_empty() {
            let mut guesses = file.create_group("guesses");
            integers(&mut guesses, "number_of_guesses", &[fit("guesses", self.guesses.len())?]);
            for (k, guess) in self.guesses.iter().enumerate() {
                let name = (k + 1).to_string();
                let mut group = guesses.create_group(&name);
                self.solution(&mut group, guess, &format!("guesses/{name}"))?;
                guesses.add_group(group.finish());
            }
            file.add_group(guesses.finish());
        }
        if let Some(solution) = &self.solution {
            let mut group = file.create_group("solution");
            self.solution(&mut group, solution, "solution")?;
            file.add_group(group.finish());
        }
        file.finish().map_err(|error| FclibError::Unwritable { reason: error.to_string() })
    }

    fn solution(&self, group: &mut GroupBuilder, solution: &Solution<D>, name: &str) -> Result<(), FclibError> {
        for (part, vectors) in [("u", &solution.u), ("r", &solution.r)] {
            let name = || format!("{name}/{part}");
            if vectors.len() != self.q.len() {
                let (found, expected) = ((D * vectors.len()) as u64, (D * self.q.len()) as u64);
                return Err(FclibError::Size { name: name(), found, expected });
            }
            for (contact, vector) in vectors.iter().enumerate() {
                if let Some(&value) = vector.iter().find(|c| !c.is_finite()) {
                    return Err(FclibError::NotFinite { name: name(), contact, value });
                }
            }
            numbers(group, part, &flat(vectors));
        }
        for (part, values) in [("v", &solution.v), ("l", &solution.l)] {
            if !values.is_empty() {
                numbers(group, part, values);
            }
        }
        Ok(())
    }
}

fn flat<const D: usize>(vectors: &[Vector<D>]) -> Vec<f64> {
    vectors.iter().flat_map(|v| v.iter().copied()).collect()
}

/// Converts a size to the format's 32-bit integer.
pub(crate) fn fit(name: &str, value: usize) -> Result<i32, FclibError> {
    i32::try_from(value).map_err(|_| FclibError::Size {
        name: name.to_owned(),
        found: value as u64,
        expected: i32::MAX as u64,
    })
}

pub(crate) fn integers(group: &mut GroupBuilder, name: &str, values: &[i32]) {
    group.create_dataset(name).with_i32_data(values).with_shape(&[values.len() as u64]);
}

pub(crate) fn numbers(group: &mut GroupBuilder, name: &str, values: &[f64]) {
    group.create_dataset(name).with_f64_data(values).with_shape(&[values.len() as u64]);
}

/// Writes a text as fclib does: one string of fixed length that ends with NUL.
fn text(group: &mut GroupBuilder, name: &str, value: &str) -> Result<(), FclibError> {
    let too_long = || FclibError::Unwritable { reason: format!("the {name} is too long") };
    if value.contains('\0') {
        return Err(FclibError::Unwritable { reason: format!("the {name} contains the character NUL") });
    }
    let size = u32::try_from(value.len() + 1).map_err(|_| too_long())?;
    let charset = if value.is_ascii() { CharacterSet::Ascii } else { CharacterSet::Utf8 };
    let mut bytes = value.as_bytes().to_vec();
    bytes.push(0);
    let datatype = Datatype::String { size, padding: StringPadding::NullTerminate, charset };
    group.create_dataset(name).with_raw_data(datatype, bytes, 1).with_shape(&[]);
    Ok(())
}
