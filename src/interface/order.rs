//! Orders of a calibration.

use super::enquiry::name;
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
    if matches!(node, Node::List(_)) {
        return Some(());
    }
    problems.at(at, node.describe(), "a list of results of `calibrate`", "");
    None
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
    if found.is_none() {
        problems.at(at, node.describe(), listed(&models.map(Model::key)), "");
    }
    found
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

    /// A laboratory and a gyro type as in the contract, in JSON.
    const LABORATORY: &str = r#"{"format": "dtg-laboratory/1", "meter": {"range_ma": 0.5, "reading_percent": 0.01,
        "gain_percent": 0, "offset_ma": 0, "floor_ma": 1e-6}, "seating_arcsec": {"about_x": 5, "about_y": 5, "about_z": 10}}"#;
    const GYRO: &str = r#"{"format": "dtg-gyro/1", "type": "T", "nominal": {"k_deg_per_h_per_ma": [[95, 9.5], [9.5, 95]],
        "omega0_deg_per_h": [20, 20], "omega_g_deg_per_h_per_g": 10, "omega_k_deg_per_h_per_g": 10},
        "tolerance": {"k_main_percent": 0.05, "k_cross_percent": 0.5, "omega0_deg_per_h": 0.01,
        "omega_g_deg_per_h_per_g": 0.01, "omega_k_deg_per_h_per_g": 0.01}}"#;

    #[test]
    fn every_key_of_an_order_is_used() {
        let text = format!(
            r#"{{"method": "iterative", "model": "general", "drift": true, "laboratory": {LABORATORY}, "gyro": {GYRO},
                "exclude": [{{"i": 2, "j": 4, "visit": 1, "cycle": 3, "why": "door"}}, {{"i": 1, "j": 1, "visit": 2, "why": "a"}}]}}"#
        );
        let order: Order = text.parse().unwrap();
        let Options { methods, model, drift, .. } = order.options;
        assert_eq!((methods, model, drift), (vec![Method::Iterative], Model::General, true));
        let excluded = |i, j, visit, cycle, why: &str| Exclusion { i, j, visit, cycle, why: why.to_owned() };
        assert_eq!(order.exclude, [excluded(2, 4, 1, Some(3), "door"), excluded(1, 1, 2, None, "a")]);
        let laboratory = order.laboratory.unwrap();
        assert_eq!((laboratory.meter.range_ma, laboratory.seating_arcsec.unwrap().about_z), (0.5, 10.0));
        assert_eq!(order.gyro, Some(GyroType { r#type: "T".to_owned(), ..GyroType::gvk_6() }));
        let of_gyro = r#"{"anisoelasticity": true, "gyro_serial": "4711", "operator": "A. B.", "date": "2026-11-19", "temperature_c": -5}"#;
        let order: Order = of_gyro.parse().unwrap();
        let Subject { gyro_serial, operator, date, temperature_c, .. } = order.subject;
        assert_eq!((gyro_serial.as_deref(), operator.as_deref()), (Some("4711"), Some("A. B.")));
        assert_eq!((date.unwrap().to_string(), temperature_c), ("2026-11-19".to_owned(), Some(-5.0)));
        assert_eq!(order.options.model, Model::Anisoelastic);
        let default: Order = "{}".parse().unwrap();
        assert_eq!((default.options.methods, default.laboratory), (vec![Method::LeastSquares], None));
    }

    /// Expected: the same as from the object, and the line of an error in the text.
    #[cfg(feature = "yaml")]
    #[test]
    fn a_file_is_an_object_or_its_text() {
        let as_object: Order = format!(r#"{{"laboratory": {LABORATORY}, "gyro": {GYRO}}}"#).parse().unwrap();
        let as_json = serde_json::json!({"laboratory": LABORATORY, "gyro": GYRO}).to_string();
        assert_eq!(as_json.parse::<Order>().unwrap(), as_object);
        let yaml = "format: dtg-laboratory/1\nmeter: {range_ma: 0.5, reading_percent: 0.01, gain_percent: 0, offset_ma: 0,\n  \
                    floor_ma: 1e-6}\nseating_arcsec: {about_x: 5, about_y: 5, about_z: 10}\n";
        let as_yaml = |text: &str| serde_json::json!({"laboratory": text, "gyro": GYRO}).to_string().parse::<Order>();
        assert_eq!(as_yaml(yaml).unwrap(), as_object);
        let failed = as_yaml(&yaml.replace("about_x", "about_w")).unwrap_err();
        assert!(failed.message.contains("laboratory:4:"), "{failed}");
    }

    /// Expected: the words for the same error in a file.
    #[test]
    fn every_error_of_an_order_is_named_with_its_field() {
        let laboratory = |from: &str, to: &str| format!(r#"{{"laboratory": {}}}"#, LABORATORY.replacen(from, to, 1));
        let gyro = |from: &str, to: &str| format!(r#"{{"gyro": {}}}"#, GYRO.replacen(from, to, 1));
        for (text, words) in [
            (
                "[]".to_owned(),
                "order: found a list of 0 items, expected a mapping with the keys method, model, anisoelasticity, drift",
            ),
            ("{".to_owned(), "the order is not usable JSON"),
            (r#"{"drift": 1}"#.to_owned(), "drift: found 1, expected true or false"),
            (r#"{"gyro": null}"#.to_owned(), "gyro: found null, expected a value; leave the key out"),
            (
                r#"{"model": "general", "anisoelasticity": true}"#.to_owned(),
                "anisoelasticity: found true, expected false with the general model",
            ),
            (r#"{"temperature_c": -91}"#.to_owned(), "temperature_c: found -91"),
            (r#"{"previous": {}}"#.to_owned(), "previous: found a mapping"),
            (r#"{"model": "anisoelastic"}"#.to_owned(), "expected \"paper\" or \"general\""),
            (
                r#"{"method": "exact"}"#.to_owned(),
                "method: found \"exact\", expected \"analytic\", \"iterative\" or \"least-squares\"",
            ),
            (r#"{"drift": true, "drift": false}"#.to_owned(), "duplicate key \"drift\""),
            (r#"{"exclude": [{"i": 1, "j": 2, "visit": 1}]}"#.to_owned(), "exclude[0].why: missing, expected text"),
            (r#"{"exclude": [{"i": 1.5, "j": 2, "visit": 1, "why": ""}]}"#.to_owned(), "exclude[0].i: found 1.5"),
            (laboratory("1e-6", "0"), "order: laboratory.meter.floor_ma: found 0, expected a positive number; use at"),
            (laboratory("1e-6", "null"), "laboratory.meter.floor_ma: found nothing, expected a number in milliamperes"),
            (laboratory("about_x", "about_w"), "laboratory.seating_arcsec: found unknown key \"about_w\""),
            (laboratory("\"meter\"", "\"meter\": 1, \"meter\""), "laboratory: found duplicate key \"meter\""),
            (
                laboratory("dtg-laboratory/1", "dtg-gyro/1"),
                "laboratory.format: found \"dtg-gyro/1\", expected \"dtg-lab",
            ),
            (
                laboratory("\"format\": \"dtg-laboratory/1\",", ""),
                "laboratory.format: missing, expected \"dtg-laboratory/1\"",
            ),
            (gyro("0.05", "-1"), "gyro.tolerance.k_main_percent: found -1, expected a non-negative number"),
        ] {
            let failed = text.parse::<Order>().unwrap_err();
            assert!(failed.code == "unusable" && failed.message.contains(words), "{text}: {failed}");
        }
        let both = laboratory("1e-6", "0").replacen('{', r#"{"methods": 1, "#, 1).parse::<Order>().unwrap_err();
        assert_eq!(both.message.lines().count(), 2, "{both}");
    }
}
