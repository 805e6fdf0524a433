//! Location of a value in hand-written YAML, found again if an error needs it.

use super::excerpt::{Location, Step};
use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// Finds the line and column of an error by reading the text again up to it.
///
/// `serde_yaml` reports only the location of errors, so this function raises an error at the target.
pub(crate) fn locate(text: &str, steps: &[Step]) -> Option<Location> {
    let error = Probe(steps).deserialize(serde_yaml::Deserializer::from_str(text)).err()?;
    error.location().map(|at| Location { line: at.line(), column: at.column() })
}

/// Deserialiser that fails at the target, so that `serde_yaml` reports its location: at a scalar because it expects none.
#[derive(Clone, Copy)]
struct Probe<'a>(&'a [Step]);

impl<'de> DeserializeSeed<'de> for Probe<'_> {
    type Value = ();
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Probe<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a plain YAML value without a tag")
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        if let Some((Step::Item(target), rest)) = self.0.split_first() {
            for _ in 0..*target {
                list.next_element::<de::IgnoredAny>()?;
            }
            list.next_element_seed(Probe(rest))?;
        }
        Err(de::Error::custom("here"))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        match self.0.split_first() {
            Some((Step::Key(target), rest)) => {
                while let Some(key) = map.next_key::<String>()? {
                    if key == *target {
                        map.next_value_seed(Probe(rest))?;
                    } else {
                        map.next_value::<de::IgnoredAny>()?;
                    }
                }
            }
            Some((Step::Entry(target), _)) => {
                for _ in 0..*target {
                    map.next_entry::<de::IgnoredAny, de::IgnoredAny>()?;
                }
                map.next_key_seed(Probe(&[]))?;
            }
            _ => {}
        }
        Err(de::Error::custom("here"))
    }
}
