//! Tests of the library without any feature: from bytes, keys and a time to an answer.

use dtg_passport::calibration::{CalibrationDocument, Kind, NotValid, Options, Parameter, Readings, Setup, calibrate};
use dtg_passport::earth::Place;
use dtg_passport::interface;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::{CheckName, Code, Question, Trust, verify};
use dtg_passport::register::VerifiedRegister;
use dtg_passport::trust::AllowedSigners;
use std::fs;

fn read(path: &str) -> Vec<u8> {
    fs::read(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn trust() -> Trust {
    Trust::of(AllowedSigners::parse("allowed_signers", &read("docs/allowed_signers")).unwrap())
}

fn question() -> Question {
    Question::at("2026-12-01T00:00:00Z".parse().unwrap())
}

#[test]
fn a_signed_passport_is_verified_and_an_altered_one_refused() {
    let good = read("passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let answer = verify("good", &good, &trust(), &question());
    assert!(answer.valid(), "{:#?}", answer.checks());

    let altered = String::from_utf8(good).unwrap().replacen("SPS-2", "SPS-3", 1);
    let answer = verify("altered", altered.as_bytes(), &trust(), &question());
    assert_eq!(answer.code(CheckName::Signature), Some(Code::Altered));
    assert!(answer.passport().is_none());
}

/// Expected: the shipped register lists the shipped passports of its stand, as current, and answers for no other stand. One
/// that is altered makes no passport valid. The same by the interface of the other languages.
#[test]
fn a_register_is_asked() {
    const PASSPORT: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
    let question = question();
    let verified = |bytes: &[u8]| VerifiedRegister::verify("register.yaml", bytes, &trust(), question.now);
    let bytes = read("passports/SPS-2/0017/register.yaml");
    let register = verified(&bytes).unwrap();
    let answer =
        |path: &str| verify(path, &read(path), &trust(), &question).with_register(Ok((&register, None)), &question);
    let [good, other] = [PASSPORT, "passports/SPS-1/0203/moscow-bmstu-1.yaml"].map(answer);
    assert!(good.valid() && good.code(CheckName::Register) == Some(Code::Ok), "{:#?}", good.checks());
    assert!(!other.valid() && other.code(CheckName::Register) == Some(Code::RegisterUnknown));

    let altered = String::from_utf8(bytes.clone()).unwrap().replacen("2026-11-09", "2026-11-10", 1).into_bytes();
    let refused = verified(&altered).unwrap_err();
    let answer = verify(PASSPORT, &read(PASSPORT), &trust(), &question).with_register(Err(&refused), &question);
    assert!(!answer.valid() && answer.code(CheckName::Register) == Some(Code::RegisterUnknown));

    for (register, valid, code) in [(&bytes, true, "ok"), (&altered, false, "register_unknown")] {
        let asked = serde_json::json!({ "register": String::from_utf8(register.clone()).unwrap() }).to_string();
        let signers = read("docs/allowed_signers");
        let enquiry = interface::Enquiry::new(("allowed_signers", &signers), &[], &asked, question.now).unwrap();
        let answer: serde_json::Value =
            serde_json::from_str(&enquiry.verify(PASSPORT, &read(PASSPORT)).to_json()).unwrap();
        let checks = answer["checks"].as_array().unwrap();
        let check = checks.iter().find(|check| check["name"] == "register").unwrap();
        assert_eq!((&answer["valid"], &check["code"]), (&valid.into(), &code.into()), "{answer}");
    }
}

/// Expected: the coordinates of sites/moscow-bmstu.yaml, in the wrong order, and those of Beijing.
#[test]
fn exchanged_coordinates_are_recognised() {
    let file = read("passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let detail = |latitude_deg, longitude_deg| {
        let mut question = question();
        question.place = Some(Place { latitude_deg, longitude_deg });
        let answer = verify("good", &file, &trust(), &question);
        assert_eq!(answer.code(CheckName::Place), Some(Code::WrongPlace));
        answer.checks().iter().find(|check| check.name == CheckName::Place).unwrap().detail.clone()
    };
    assert!(detail(37.6856, 55.7658).ends_with("; check whether latitude and longitude are exchanged"));
    assert!(detail(40.2455, 116.2240).ends_with("; request a re-issue for this place from the factory"));
    assert!(detail(55.7658, -37.6856).ends_with("; check the sign of the longitude; it is negative in the west"));
    assert!(detail(-55.7658, 37.6856).ends_with("; check the sign of the latitude; it is negative in the south"));
    assert!(detail(-55.7658, -37.6856).contains("; check the signs of latitude and longitude"));
    assert!(detail(-55.7658, 175.0).ends_with("; request a re-issue for this place from the factory"));
}

/// Expected: the identifier of the stand, or spaces, instead of its serial number: still the wrong stand, with the remedy.
#[test]
fn the_model_is_not_part_of_the_serial_number() {
    let file = read("passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let detail = |serial: &str| {
        let mut question = question();
        question.serial = Some(serial.to_owned());
        let answer = verify("good", &file, &trust(), &question);
        assert_eq!(answer.code(CheckName::Stand), Some(Code::WrongStand));
        answer.checks().iter().find(|check| check.name == CheckName::Stand).unwrap().detail.clone()
    };
    for serial in ["SPS-2/0017", "SPS-2 0017", "0017 ", "SPS-2-0017"] {
        let due = format!("the passport is for stand SPS-2 0017; give only the serial number, 0017, not {serial:?}");
        assert_eq!(detail(serial), due);
    }
    // Excel takes 0017 for a number.
    for serial in ["17", "00017"] {
        assert!(detail(serial).ends_with("the zeros before a serial number are part of it"), "{}", detail(serial));
    }
    assert!(detail("SPS-2/0018").ends_with("not SPS-2/0018; its deviations do not apply to stand SPS-2/0018"));
}

/// Returns what the passport in docs and the paper's laboratory state, verified.
fn setup() -> Setup {
    let answer = verify("good", &read("passports/SPS-2/0017/moscow-bmstu-1.yaml"), &trust(), &question());
    let passport = answer.passport().unwrap();
    let content = passport.content();
    let stated = Setup::stated(&content.certificate, &content.positions, &content.site, &Laboratory::paper());
    stated.unwrap().0
}

/// Expected: the gyro of docs/currents.csv is the paper's, K_x = 95 °/h/mA, read with the paper's meter.
#[test]
fn readings_in_the_laboratory_give_the_parameters() {
    let setup = setup();
    let (currents, range_ma) = (read("docs/currents.csv"), Laboratory::paper().meter.range_ma);
    let readings = Readings::from_csv("currents.csv", &currents, setup.coefficients(), range_ma).unwrap();
    let calibration = calibrate(&setup, &readings, &Options::default()).unwrap();
    let result = calibration.valid().unwrap();
    let (k_x, u) = (result.value(Parameter::Kx).unwrap(), result.standard_uncertainty(Parameter::Kx).unwrap());
    assert!((k_x - 95.0).abs() < 3.0 * u && u < 0.02, "{k_x}, u {u}");
}

/// Expected: no parameters from docs/currents.csv with one current 100 µA off, nor with all currents in microamperes; and from
/// the JSON of such a result the same answer.
#[test]
fn a_result_that_is_not_valid_is_no_answer() {
    let setup = setup();
    let good = String::from_utf8(read("docs/currents.csv")).unwrap();
    let result = |csv: &str| {
        let readings = Readings::from_csv("currents.csv", csv.as_bytes(), setup.coefficients(), 1000.0).unwrap();
        let calibration = calibrate(&setup, &readings, &Options::default()).unwrap();
        let document = CalibrationDocument::new("id", true, (9.8157, None), &calibration, &[]);
        let json = serde_json::to_string(&document).unwrap();
        (calibration, CalibrationDocument::from_json("result", json.as_bytes()).unwrap())
    };
    let (calibration, document) = result(&good);
    assert!(calibration.valid().is_ok() && document.valid().is_ok());

    let (calibration, document) = result(&good.replace("-0.3002995", "-0.4002995"));
    assert!(matches!(calibration.valid(), Err(NotValid::Inconsistent(_))), "{:?}", calibration.valid());
    assert!(matches!(document.valid(), Err(NotValid::Inconsistent(_))), "{:?}", document.valid());

    let thousandfold = |cell: &str| cell.parse().map_or_else(|_| cell.to_owned(), |ma: f64| (1000.0 * ma).to_string());
    let in_microamperes = |line: &str| match line.split(',').collect::<Vec<_>>()[..] {
        [i, j, x, y] => format!("{i},{j},{},{}\n", thousandfold(x), thousandfold(y)),
        _ => format!("{line}\n"),
    };
    let (calibration, document) = result(&good.lines().map(in_microamperes).collect::<String>());
    let mistake = calibration.mistake().unwrap();
    assert_eq!((mistake.kind, mistake.size), (Kind::Range, Some(1000.0)));
    let mistaken = NotValid::Mistaken(mistake.words.clone());
    assert_eq!((calibration.valid().unwrap_err(), document.valid().unwrap_err()), (mistaken.clone(), mistaken));
}

/// Returns the order of a calibration by `method`, with the gyro type and the laboratory of the files in docs.
fn order(method: &str, previous: &[&serde_json::Value]) -> interface::Order {
    let mut order = serde_json::json!({
        "gyro": {
            "format": "dtg-gyro/1",
            "type": "GVK-6",
            "nominal": {
                "k_deg_per_h_per_ma": [[95, 9.5], [9.5, 95]],
                "omega0_deg_per_h": [20, 20],
                "omega_g_deg_per_h_per_g": 10,
                "omega_k_deg_per_h_per_g": 10,
            },
            "tolerance": {
                "k_main_percent": 0.05,
                "k_cross_percent": 0.5,
                "omega0_deg_per_h": 0.01,
                "omega_g_deg_per_h_per_g": 0.01,
                "omega_k_deg_per_h_per_g": 0.01,
            },
        },
        "laboratory": {
            "format": "dtg-laboratory/1",
            "name": "Gyro laboratory",
            "meter": {"range_ma": 1.0, "reading_percent": 0.0087, "gain_percent": 0.0, "offset_ma": 0.0, "floor_ma": 1e-6},
            "seating_arcsec": {"about_x": 5.0, "about_y": 5.0, "about_z": 10.0},
            "base": {"azimuth_arcsec": 10.0, "level_arcsec": 3.0},
        },
    });
    order["method"] = method.into();
    order["previous"] = previous.iter().copied().cloned().collect();
    order.to_string().parse().unwrap()
}

/// Returns the result of currents on the stand of the passport in docs, verified.
fn calibrated(currents: &str, order: &interface::Order) -> serde_json::Value {
    let answer = verify("good", &read("passports/SPS-2/0017/moscow-bmstu-1.yaml"), &trust(), &question());
    let passport = answer.passport().unwrap();
    let found = interface::calibrate_json(
        passport.content(),
        Some((question().time, None)),
        ("run.csv", currents.as_bytes()),
        order,
    );
    let found = found.unwrap_or_else(|failed| failed.result.unwrap());
    serde_json::from_str(&found).unwrap()
}

/// Returns a run of `turn_ons`, each with `visits` of `count` rows to each position, whose currents are those of
/// docs/currents.csv and differ by up to 1 nA; `error_ma` is what is added to J_x and J_y of a row by its place: turn-on,
/// visit, row and position, from 0.
fn run([turn_ons, visits, count]: [usize; 3], error_ma: impl Fn([usize; 4]) -> [f64; 2]) -> String {
    let currents = String::from_utf8(read("docs/currents.csv")).unwrap();
    let rows = currents.lines().filter(|line| line.starts_with(['1', '2']));
    let rows: Vec<Vec<f64>> = rows.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let mut text = "i,j,jx_ma,jy_ma,cycle,visit\n".to_owned();
    for turn_on in 0..turn_ons {
        for visit in 0..visits {
            for (at, row) in rows.iter().enumerate() {
                for number in 0..count {
                    let error_ma = error_ma([turn_on, visit, number, at]);
                    let current = |axis: usize| {
                        let mixed = 7 * turn_on + 29 * visit + 5 * number + 17 * at + 11 * axis;
                        row[2 + axis] + 1e-6 * ((mixed % 13) as f64 / 6.0 - 1.0) + error_ma[axis]
                    };
                    let (x, y) = (current(0), current(1));
                    text += &format!("{},{},{x:.7},{y:.7},{},{}\n", row[0], row[1], turn_on + 1, visit + 1);
                }
            }
        }
    }
    text
}

/// Returns `true` if a cause is the visit of this number to a position, from 0, in a turn-on.
fn is_visit(cause: &serde_json::Value, position: usize, turn_on: usize, visit: usize) -> bool {
    let index = [position / 4 + 1, position % 4 + 1, turn_on, visit];
    ["i", "j", "cycle", "visit"].iter().zip(index).all(|(key, number)| cause["scope"][*key] == number)
}

/// Errors along one axis, mA.
const ERRORS_MA: [[f64; 2]; 4] = [[0.01, 0.0], [-0.01, 0.0], [0.0, 0.01], [0.0, -0.01]];

/// Expected: the gyro of docs/currents.csv conforms to its type, so no single mistyped current makes it fail; and of two
/// visits or rows the one with the mistake is named, because the readings fit the stand without it.
#[test]
fn one_wrong_visit_does_not_fail_a_gyro() {
    for (design, method) in [
        ([1, 2, 1], "least-squares"),
        ([1, 3, 1], "least-squares"),
        ([1, 1, 2], "least-squares"),
        ([1, 1, 3], "least-squares"),
        ([2, 1, 1], "analytic"),
        ([3, 1, 1], "iterative"),
    ] {
        let order = order(method, &[]);
        let [turn_ons, visits, count] = design;
        for place in 0..8 {
            for error_ma in ERRORS_MA {
                let wrong = [turn_ons - 1, visits - 1, count - 1, place];
                let text = run(design, |at| if at == wrong { error_ma } else { [0.0, 0.0] });
                let found = calibrated(&text, &order);
                let case = format!("{design:?} {method}: {error_ma:?} mA in position {place}: {found}");
                assert_ne!(found["verdict"]["overall"], "fail", "{case}");
                assert!(is_visit(&found["causes"][0], place, turn_ons, visits), "{case}");
                let suspect = &found["causes"][0]["scope"];
                assert_eq!(suspect.get("row").is_some(), count > 1, "{case}");
                assert!(count == 1 || suspect["row"] == count, "{case}");
                assert!(!found["causes"].to_string().contains("Either this or another"), "{case}");
            }
        }
    }
}

/// Expected: without either of the two visits of a second turn-on the readings agree, so both are named if one is wrong; and
/// so is a wrong visit of the first turn-on.
#[test]
fn the_wrong_visit_is_among_those_named_if_a_turn_on_has_two_positions() {
    let order = order("least-squares", &[]);
    for positions in [[0, 1], [2, 5], [3, 7], [6, 4]] {
        for (wrong, error_ma) in (0..4).flat_map(|wrong| ERRORS_MA.map(|error_ma| (wrong, error_ma))) {
            let (turn_on, position) = (wrong / 2, positions[wrong % 2]);
            let all = run([2, 2, 1], |at| if at == [turn_on, 0, 0, position] { error_ma } else { [0.0, 0.0] });
            // The header, two visits in the first turn-on, and one to each of the two positions in the second.
            let kept = |at: usize| at <= 16 || (at <= 24 && positions.contains(&((at - 1) % 8)));
            let lines = all.lines().enumerate().filter(|(at, _)| kept(*at)).map(|(_, line)| line.to_owned() + "\n");
            let found = calibrated(&lines.collect::<String>(), &order);
            let case = format!("{positions:?}: {error_ma:?} mA in turn-on {turn_on}, position {position}: {found}");
            assert_ne!(found["verdict"]["overall"], "fail", "{case}");
            let suspects = found["causes"].as_array().unwrap();
            let suspects: Vec<_> = suspects.iter().filter(|cause| cause["kind"] == "visit").collect();
            assert!(suspects.iter().any(|suspect| is_visit(suspect, position, turn_on + 1, 1)), "{case}");
            let several =
                |suspect: &&serde_json::Value| suspect["words"].to_string().contains("Either this or another");
            assert!(suspects.iter().all(|suspect| several(suspect) == (suspects.len() > 1)), "{case}");
        }
    }
}

/// Expected: the gyro of docs/currents.csv; the readings fit the stand without the visit that is wrong by 1 µA.
#[test]
fn a_closing_visit_or_the_first_one_to_its_position_that_is_wrong_is_named() {
    let order = order("least-squares", &[]);
    for (place, wrong) in (0..8).flat_map(|place| [(place, 0), (place, 1)]) {
        for error_ma in ERRORS_MA {
            let error_ma = error_ma.map(|error| error / 10.0);
            let all = run([1, 2, 1], |at| if at == [0, wrong, 0, place] { error_ma } else { [0.0, 0.0] });
            let lines = all.lines().enumerate().filter(|(at, _)| *at <= 8 || at - 9 == place);
            let found = calibrated(&lines.map(|(_, line)| line.to_owned() + "\n").collect::<String>(), &order);
            let case = format!("visit {} to position {place}, {error_ma:?} mA: {found}", wrong + 1);
            assert_ne!(found["verdict"]["overall"], "fail", "{case}");
            let [suspect] = &found["causes"].as_array().unwrap()[..] else { panic!("{case}") };
            assert!(is_visit(suspect, place, 1, wrong + 1), "{case}");
        }
    }
}

/// A second wrong visit is found only without the first; the good gyro does not fail. Nor does it fail for a change since a
/// result in which a visit was wrong.
#[test]
fn no_decision_rests_on_a_second_wrong_visit_or_on_a_wrong_earlier_one() {
    let two = |places: [usize; 2]| {
        run([1, 3, 1], move |[_, visit, _, at]| match places {
            [first, _] if (visit, at) == (2, first) => [0.0093, 0.0],
            [_, second] if (visit, at) == (1, second) => [0.0087, 0.0],
            _ => [0.0, 0.0],
        })
    };
    let now = order("least-squares", &[]);
    for places in [[0, 1], [2, 4], [5, 3], [6, 7], [1, 6]] {
        let found = calibrated(&two(places), &now);
        assert_ne!(found["verdict"]["overall"], "fail", "{places:?}: {found}");
    }
    let wrong = calibrated(&run([1, 2, 1], |at| if at == [0, 1, 0, 1] { [0.01, 0.0] } else { [0.0, 0.0] }), &now);
    let good = run([1, 2, 1], |[_, visit, _, at]| [1e-7 * (visit + at) as f64, 0.0]);
    let found = calibrated(&good, &order("least-squares", &[&wrong]));
    assert_eq!(found["change"]["overall"], "undecided", "{found}");
    let earlier = calibrated(&run([1, 2, 1], |_| [0.0, 0.0]), &now);
    assert_ne!(calibrated(&good, &order("least-squares", &[&earlier]))["change"]["overall"], "fail");
}
