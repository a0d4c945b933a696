//! What decides the rows of a study: they can be continued and merged only where it is the same.

use super::Shard;
use serde_json::{Value, json};
use teeter_report::content_hash;

/// The file of a folder of results that holds it.
pub const IDENTITY: &str = "sweep.json";

/// The version of the program, the sweep, the scene and its files, and the shard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SweepIdentity {
    /// The name of the sweep file, for titles; it decides nothing.
    title: String,
    program: String,
    sweep: String,
    inputs: String,
    cases: u64,
    shard: Shard,
}

/// Why rows don't belong together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepIdentityError {
    /// The file doesn't hold an identity.
    #[error("it is not a file that `teeter sweep` wrote")]
    Unreadable,
    /// Another version of the program, whose rows may differ.
    #[error("its rows are of version {then} of the program, not {now}")]
    Program {
        /// The version that wrote them.
        then: String,
        /// This one.
        now: String,
    },
    /// The sweep file is another one.
    #[error("the sweep file has changed since")]
    Sweep,
    /// The scene, or a file that it reads, has changed.
    #[error("the scene, or a file that it reads, has changed since")]
    Inputs,
    /// Another shard.
    #[error("it holds shard {then}, not {now}")]
    Shard {
        /// The shard of the folder.
        then: Shard,
        /// The shard asked for.
        now: Shard,
    },
}

impl SweepIdentity {
    /// The identity of a study of so many cases by the sweep file `sweep`; `inputs` are the bytes of
    /// the scene and of the files that it reads.
    pub fn new<'a>(sweep: &str, inputs: impl IntoIterator<Item = &'a [u8]>, cases: u64, shard: Shard) -> Self {
        let inputs = content_hash(inputs).iter().map(|byte| format!("{byte:02x}")).collect();
        Self {
            title: String::new(),
            program: env!("CARGO_PKG_VERSION").to_owned(),
            sweep: sweep.to_owned(),
            inputs,
            cases,
            shard,
        }
    }

    /// The same study with a title.
    #[must_use]
    pub fn titled(self, title: &str) -> Self {
        Self { title: title.to_owned(), ..self }
    }

    /// The title of its page; empty if it has none.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The shard.
    #[must_use]
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// The identity of the same study with all cases.
    #[must_use]
    pub fn as_whole(&self) -> Self {
        Self { shard: Shard::ALL, ..self.clone() }
    }

    /// The number of cases of the whole study.
    #[must_use]
    pub fn cases(&self) -> u64 {
        self.cases
    }

    /// The sweep file.
    #[must_use]
    pub fn sweep(&self) -> &str {
        &self.sweep
    }

    /// As the text of its file.
    #[must_use]
    pub fn to_json(&self) -> String {
        let Self { title, program, sweep, inputs, cases, shard } = self;
        let value = json!({
            "title": title, "program": program, "cases": cases, "shard": shard.to_string(), "inputs_sha256": inputs, "sweep": sweep,
        });
        format!("{value:#}\n")
    }

    /// Reads the text of its file.
    ///
    /// # Errors
    /// If it is another file.
    pub fn from_json(text: &str) -> Result<Self, SweepIdentityError> {
        let value: Value = serde_json::from_str(text).map_err(|_| SweepIdentityError::Unreadable)?;
        let text = |key: &str| value.get(key).and_then(Value::as_str).map(str::to_owned);
        let read = || {
            Some(Self {
                title: text("title").unwrap_or_default(),
                program: text("program")?,
                sweep: text("sweep")?,
                inputs: text("inputs_sha256")?,
                cases: value.get("cases")?.as_u64()?,
                shard: text("shard")?.parse().ok()?,
            })
        };
        read().ok_or(SweepIdentityError::Unreadable)
    }

    /// Whether rows of the study `then` are rows of this one, whatever the shard.
    ///
    /// # Errors
    /// What differs.
    pub fn admit_study(&self, then: &Self) -> Result<(), SweepIdentityError> {
        if then.program != self.program {
            return Err(SweepIdentityError::Program { then: then.program.clone(), now: self.program.clone() });
        }
        if then.sweep != self.sweep || then.cases != self.cases {
            return Err(SweepIdentityError::Sweep);
        }
        if then.inputs != self.inputs {
            return Err(SweepIdentityError::Inputs);
        }
        Ok(())
    }

    /// Whether a folder of `then` can be continued as this study and shard.
    ///
    /// # Errors
    /// What differs.
    pub fn admit(&self, then: &Self) -> Result<(), SweepIdentityError> {
        self.admit_study(then)?;
        if then.shard == self.shard {
            Ok(())
        } else {
            Err(SweepIdentityError::Shard { then: then.shard, now: self.shard })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_reads_back_and_tells_what_differs() {
        let of = |sweep: &str, input: &[u8], shard: &str| SweepIdentity::new(sweep, [input], 4, shard.parse().unwrap());
        let own = of("scene = \"a\"\n", b"[time]", "1/2");
        assert_eq!(SweepIdentity::from_json(&own.to_json()), Ok(own.clone()));
        assert_eq!(own.admit(&of("scene = \"b\"\n", b"[time]", "1/2")), Err(SweepIdentityError::Sweep));
        assert_eq!(own.admit(&of("scene = \"a\"\n", b"[tim]", "1/2")), Err(SweepIdentityError::Inputs));
        let other = of("scene = \"a\"\n", b"[time]", "2/2");
        assert_eq!(own.admit(&other).unwrap_err().to_string(), "it holds shard 2/2, not 1/2");
        assert_eq!(own.admit_study(&other), Ok(()));
        assert_eq!(SweepIdentity::from_json("{}"), Err(SweepIdentityError::Unreadable));
    }
}
