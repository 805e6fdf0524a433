//! Orders of a calibration.

use super::enquiry::{name, or_refused};
use super::{Asked, Failed};
use crate::calibration::document::Subject;
use crate::calibration::readings::Exclusion;
use crate::calibration::{CalibrationDocument, Method, Model, Options};
use crate::gyro::GyroType;
use crate::laboratory::{Laboratory, TEMPERATURES_C};
use crate::text::record::File;
use crate::text::words::listed;
use crate::text::{Document, Field, Node, Path, Problems, Unreadable};
use jiff::civil::Date;
use serde::Deserialize;
use serde_json::value::RawValue;
use std::str::FromStr;

/// Order of a calibration: the laboratory's meter and seat, the gyro type, and how to calibrate.
///
/// It is read from JSON, `{method, model, anisoelasticity, drift, exclude: [{i, j, visit, cycle, why}], laboratory, gyro,
/// gyro_serial, operator, date, temperature_c, previous, budget}`, in which every key may be absent:
///
/// * `method` is `least-squares` (the default), `analytic` or `iterative`.
/// * `model` of the g-sensitive drift is `paper` (the default) or `general`; `anisoelasticity` is `true` to fit the
///   anisoelastic coefficient too, and `drift` is `true` to fit a linear drift of ω_0 in time.
/// * `exclude` are visits to leave out, each with its reason, and with its `cycle` if several have a visit of that number.
/// * `laboratory` and `gyro` are the files `dtg-laboratory/1` and `dtg-gyro/1`: their text, YAML or JSON, or an object.
/// * `gyro_serial`, `operator`, `date` (YYYY-MM-DD) and `temperature_c` (°C) say what was measured, by whom, when and at
///   which temperature; the result repeats them.
/// * `previous` are earlier results of the same gyro, as `calibrate` returned them. With `gyro`, the result has the change
///   since the latest of them.
/// * `budget` is `true` to add the budget of the uncertainty.
///
/// ```
/// use dtg_passport::interface::Order;
///
/// let order: Order = r#"{"method": "analytic"}"#.parse()?;
/// assert!(order.gyro.is_none() && order.laboratory.is_none());
/// let refused = r#"{"metod": "analytic"}"#.parse::<Order>().unwrap_err();
/// assert!(refused.message.contains("did you mean method?"));
/// # Ok::<(), dtg_passport::interface::Failed>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    pub(crate) options: Options,
    pub(crate) exclude: Vec<Exclusion>,
    /// `true` to add the budget of the uncertainty to the result.
    pub(crate) budget: bool,
    pub(crate) subject: Subject,
    pub(crate) previous: Vec<CalibrationDocument>,
    /// Laboratory, or `None` for the paper's meter.
    pub laboratory: Option<Laboratory>,
    /// Gyro type for the verdict, or `None` for no verdict.
    pub gyro: Option<GyroType>,
}

impl FromStr for Order {
    type Err = Failed;

    fn from_str(text: &str) -> Result<Self, Failed> {
        let mut asked = Asked::new("order", text)?;
        let methods = vec![asked.key("method", Method::read).unwrap_or(Method::LeastSquares)];
        let paper_or_general = asked.key("model", model).unwrap_or_default();
        let anisoelastic = |node: &Node, at: &Path, problems: &mut Problems| {
            let fitted = bool::read(node, at, problems)?;
            if fitted && paper_or_general == Model::General {
                problems.at(at, "true", "false with the general model, which does not have this coefficient", "");
            }
            Some(fitted)
        };
        let anisoelasticity = asked.key("anisoelasticity", anisoelastic).unwrap_or_default();
        let mut order = Self {
            options: Options {
                methods,
                model: if anisoelasticity { Model::Anisoelastic } else { paper_or_general },
                drift: asked.key("drift", bool::read).unwrap_or_default(),
                ..Options::default()
            },
            exclude: asked.key("exclude", Vec::read).unwrap_or_default(),
            budget: asked.key("budget", bool::read).unwrap_or_default(),
            laboratory: None,
            gyro: None,
            subject: Subject {
                gyro_serial: asked.key("gyro_serial", name),
                operator: asked.key("operator", name),
                date: asked.key("date", Date::read),
                temperature_c: asked.key("temperature_c", temperature),
                ..Subject::default()
            },
            previous: Vec::new(),
        };
        let earlier = asked.key("previous", list).is_some();
        let laboratory = asked.key("laboratory", file(Laboratory::check));
        let gyro = asked.key("gyro", file(GyroType::check));
        asked.done()?;
        (order.laboratory, order.gyro) = (laboratory.transpose()?, gyro.transpose()?);
        if earlier {
            order.previous = previous(text)?;
        }
        Ok(order)
    }
}

/// Reads a temperature, °C; the limits are those of a laboratory file.
fn temperature(node: &Node, at: &Path, problems: &mut Problems) -> Option<f64> {
    let [low, high] = TEMPERATURES_C;
    let celsius = f64::read(node, at, problems)?;
    problems.within(at, Some(celsius), low, high);
    Some(celsius)
}

/// Refuses earlier results that are not a list.
fn list(node: &Node, at: &Path, problems: &mut Problems) -> Option<()> {
    let list = matches!(node, Node::List(_)).then_some(());
    or_refused(list, (node, at), "a list of results of `calibrate`", problems)
}

/// Reads the earlier results in an order, from the earliest to the latest. Each is read from its own text, as a file is.
fn previous(order: &str) -> Result<Vec<CalibrationDocument>, Failed> {
    #[derive(Deserialize)]
    struct Earlier<'a> {
        #[serde(borrow)]
        previous: Vec<&'a RawValue>,
    }
    let unusable = |error: serde_json::Error| Failed::unusable(format!("the order is not usable JSON: {error}"));
    let each = serde_json::from_str::<Earlier>(order).map_err(unusable)?.previous;
    let named = each.iter().enumerate().map(|(index, text)| (format!("previous[{index}]"), text.get().as_bytes()));
    let read = named.map(|(name, text)| CalibrationDocument::from_json(&name, text));
    let mut results: Vec<_> = read.collect::<Result<_, _>>()?;
    CalibrationDocument::sort(&mut results);
    Ok(results)
}

/// Reads a model. The anisoelastic one has the key of the paper's.
fn model(node: &Node, at: &Path, problems: &mut Problems) -> Option<Model> {
    let models = [Model::Paper, Model::General];
    let found = models.into_iter().find(|model| *node == Node::Text(model.key().to_owned()));
    or_refused(found, (node, at), &listed(&models.map(Model::key)), problems)
}

/// Returns a reader of a file, its content as an object or with `yaml` its text, with the `check` that the file has.
fn file<T: Document>(
    check: fn(&T, &Path, &mut Problems),
) -> impl Fn(&Node, &Path, &mut Problems) -> Option<Result<T, Unreadable>> {
    move |node, at, problems| {
        #[cfg(feature = "yaml")]
        if let Node::Text(text) = node {
            let check = |value: &T, problems: &mut Problems| check(value, &Path::Root, problems);
            return Some(crate::text::yaml::read_document(&at.to_string(), text.as_bytes(), check));
        }
        let File(content) = Field::read(node, at, problems)?;
        check(&content, at, problems);
        Some(Ok(content))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A laboratory as in the contract, in JSON.
    const LABORATORY: &str = r#"{"format": "dtg-laboratory/1", "meter": {"range_ma": 0.5, "reading_percent": 0.01,
        "gain_percent": 0, "offset_ma": 0, "floor_ma": 1e-6}, "seating_arcsec": {"about_x": 5, "about_y": 5, "about_z": 10}}"#;

    /// Expected: the words for the same error in a file. tests/bindings/orders.py has those of every key.
    #[test]
    fn errors_of_the_json_of_an_order_are_named_with_their_field() {
        let laboratory = |from: &str, to: &str| format!(r#"{{"laboratory": {}}}"#, LABORATORY.replacen(from, to, 1));
        for (text, words) in [
            (
                "[]".to_owned(),
                "order: found a list of 0 items, expected a mapping with the keys method, model, anisoelasticity, drift",
            ),
            ("{".to_owned(), "the order is not usable JSON"),
            (r#"{"gyro": null}"#.to_owned(), "gyro: found null, expected a value; leave the key out"),
            (r#"{"drift": true, "drift": false}"#.to_owned(), "duplicate key \"drift\""),
            (r#"{"exclude": [{"i": 1.5, "j": 2, "visit": 1, "why": ""}]}"#.to_owned(), "exclude[0].i: found 1.5"),
            (laboratory("1e-6", "null"), "laboratory.meter.floor_ma: found nothing, expected a number in milliamperes"),
            (laboratory("\"meter\"", "\"meter\": 1, \"meter\""), "laboratory: found duplicate key \"meter\""),
            (
                laboratory("\"format\": \"dtg-laboratory/1\",", ""),
                "laboratory.format: missing, expected \"dtg-laboratory/1\"",
            ),
        ] {
            let failed = text.parse::<Order>().unwrap_err();
            assert!(failed.code == "unusable" && failed.message.contains(words), "{text}: {failed}");
        }
        let both = laboratory("1e-6", "0").replacen('{', r#"{"methods": 1, "#, 1).parse::<Order>().unwrap_err();
        assert_eq!(both.message.lines().count(), 2, "{both}");
    }
}
