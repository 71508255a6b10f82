//! Results as lines: what is said of a job, and reports on one line, without times.

use serde::Serialize;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;
use std::fmt;

/// The outcome of a job, in a line.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(rename = "BatchLine"))]
pub(crate) struct Line<'a> {
    /// The line of the job, counted from 1.
    // First: where results are kept it is replaced.
    pub(super) line: usize,
    /// SHA-256 of version, options, formats and the input's bytes; null where the input cannot be read.
    pub(super) key: Option<&'a str>,
    /// The file that was read; null of what is no job.
    pub(super) input: Option<&'a str>,
    /// The file that was written; null of what is no job.
    pub(super) output: Option<&'a str>,
    #[serde(flatten)]
    pub(super) status: JobStatus,
}

/// The outcome of a job.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "status", rename_all = "kebab-case")]
pub(super) enum JobStatus {
    /// All goals are met.
    Done {
        /// The size of the file; null for a dry run.
        output_bytes: Option<u64>,
        /// As of `refine`, without seconds unless `--seconds` is given.
        #[cfg_attr(test, schemars(with = "serde_json::Value"))]
        report: Box<RawValue>,
    },
    /// A cap was reached before what was asked for.
    StoppedShort {
        /// Which one, in words.
        why: String,
        /// The size of the file; null for a dry run.
        output_bytes: Option<u64>,
        /// As of `refine`, without seconds unless `--seconds` is given.
        #[cfg_attr(test, schemars(with = "serde_json::Value"))]
        report: Box<RawValue>,
    },
    /// There is no result.
    Failed {
        /// The error.
        error: JobError,
    },
}

impl JobStatus {
    /// Whether files were written.
    pub(super) fn has_output(&self) -> bool {
        !matches!(self, Self::Failed { .. })
    }
}

/// Why a job failed.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct JobError {
    /// The part that has to be changed.
    pub(super) kind: Kind,
    /// The limit that it passed: seconds or bytes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) limit: Option<serde_json::Number>,
    /// In words.
    pub(super) message: String,
}

/// The part that has to be changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, serde::Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
    /// The line is no job.
    Line,
    /// The options make no sense.
    Options,
    /// The input or the output is at fault.
    File,
    /// It took too long.
    Time,
    /// It took too much memory.
    Memory,
    /// It ended without a word.
    Crash,
}

impl Kind {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Options => "options",
            Self::File => "file",
            Self::Time => "time",
            Self::Memory => "memory",
            Self::Crash => "crash",
        }
    }
}

/// A report on one line, with all its digits and in its order; without `seconds` unless they are wanted.
///
/// # Errors
/// It is no JSON.
pub(super) fn on_one_line(
    report: &RawValue,
    with_seconds: bool,
) -> serde_json::Result<Box<RawValue>> {
    let mut line = String::with_capacity(report.get().len());
    add(report, with_seconds, &mut line)?;
    RawValue::from_string(line)
}

fn add(value: &RawValue, with_seconds: bool, line: &mut String) -> serde_json::Result<()> {
    let text = value.get();
    match text.as_bytes().first() {
        Some(b'{') => {
            let Members(members) = serde_json::from_str(text)?;
            line.push('{');
            let mut is_first = true;
            for (name, value) in members
                .iter()
                .filter(|(name, _)| with_seconds || name != "seconds")
            {
                line.push_str(if is_first { "" } else { "," });
                is_first = false;
                line.push_str(&serde_json::to_string(name)?);
                line.push(':');
                add(value, with_seconds, line)?;
            }
            line.push('}');
        }
        Some(b'[') => {
            let items: Vec<&RawValue> = serde_json::from_str(text)?;
            line.push('[');
            for (i, item) in items.iter().enumerate() {
                line.push_str(if i == 0 { "" } else { "," });
                add(item, with_seconds, line)?;
            }
            line.push(']');
        }
        _ => line.push_str(text),
    }
    Ok(())
}

/// An object's members in their order.
struct Members<'a>(Vec<(String, &'a RawValue)>);

impl<'de> Deserialize<'de> for Members<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Members<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut members = Vec::new();
                while let Some(member) = map.next_entry()? {
                    members.push(member);
                }
                Ok(Members(members))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_keep_order_and_digits() {
        let report = "{\n  \"b\": 0.10000000000000000001,\n \"seconds\": {\"read\": 1},\n \"a\": [ {\"seconds\": 2, \"\\u00e4\\n\": \" x \"}, [], {} ] }";
        let report = RawValue::from_string(report.to_owned()).unwrap();
        let line = on_one_line(&report, false).unwrap();
        assert_eq!(
            line.get(),
            "{\"b\":0.10000000000000000001,\"a\":[{\"ä\\n\":\" x \"},[],{}]}"
        );
        let line = on_one_line(&report, true).unwrap();
        assert!(
            line.get().contains("\"seconds\":{\"read\":1}") && line.get().contains("\"seconds\":2")
        );
    }
}
