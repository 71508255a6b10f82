//! The unit of a written file's numbers, where that of the input's is known.

use std::borrow::Cow;
use std::path::Path;

use limitmesh_io::{Format, WriteOptions};

use crate::arguments::{BuildArguments, Unit};
use crate::input;
use crate::progress::Progress;

/// The units of an input and of the file that is made of it.
pub(crate) struct WrittenUnit<'a> {
    input: &'a Path,
    /// The input's format, unless it is a built-in model.
    from: Option<Format>,
    to: Format,
    own: Option<Unit>,
}

impl<'a> WrittenUnit<'a> {
    /// Of an input whose unit is that of the arguments, and a format to write.
    pub(crate) fn of(input: &'a Path, build: &BuildArguments, to: Format) -> Self {
        let is_file = input::builtin_name(input).is_none();
        let from = is_file
            .then(|| input::format_of(input, build.from).ok())
            .flatten();
        Self {
            input,
            from,
            to,
            own: build.unit,
        }
    }

    /// Whether numbers are made millimetres, which programs that print expect most of all, of a document's metres.
    fn becomes_millimetres(&self) -> bool {
        let is_document = self.from.is_some_and(Format::is_gltf);
        is_document && self.own == Some(Unit::M) && self.to == Format::ThreeMf
    }

    /// Says on standard error what becomes of the unit in a file called `output`, where people may expect another.
    pub(crate) fn note(&self, output: &str, progress: &Progress) {
        let input = input::display_name(self.input);
        let Some(own) = self.own else {
            if self.to == Format::ThreeMf && self.from.is_some() {
                progress.note(format!(
                    "{output}: in mm, as its format has a unit and {input} says none; --unit does"
                ));
            }
            return;
        };
        let name = own.name();
        if self.becomes_millimetres() {
            progress.note(format!("{output}: in mm, 1000 times the m of {input}"));
        } else if self.to.is_gltf() && own != Unit::M {
            let factor = own.in_others(Unit::M);
            progress.note(format!(
                "{output}: in m, as its node scales the {name} of {input} by {factor}"
            ));
        } else if self.from == Some(Format::ThreeMf) && self.to != Format::ThreeMf {
            progress.note(format!(
                "{output}: its numbers are {name}, as {input} says; {} files cannot say it",
                self.to
            ));
        }
    }

    /// Options for the written numbers' unit.
    pub(crate) fn options(&self, options: WriteOptions) -> WriteOptions {
        match self.own.map(|own| {
            if self.becomes_millimetres() {
                Unit::Mm
            } else {
                own
            }
        }) {
            Some(unit) => options.unit(unit.in_package()),
            None => options,
        }
    }

    /// Positions as they are written.
    pub(crate) fn positions<'p>(&self, positions: &'p [[f64; 3]]) -> Cow<'p, [[f64; 3]]> {
        match self.becomes_millimetres() {
            true => Cow::Owned(positions.iter().map(|p| p.map(|x| 1000.0 * x)).collect()),
            false => Cow::Borrowed(positions),
        }
    }
}
