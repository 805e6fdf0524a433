//! Remarks on a certification, and findings of a comparison, in the language of the page.

use crate::certification::bumped_runs::BumpedRun;
use crate::certification::compared::ComparedPosition;
use crate::certification::finding::{Finding, Untested};
use crate::certification::remark::Remark;
use crate::certification::suspects::{AXES, OUTLIER};
use crate::report::page::language::{Language, Text};
use crate::report::page::number::Number;
use crate::report::page::parts::date_text;
use crate::report::page::texts::{certification as terms, remarks as texts};
use crate::stand::remarks::Odd;

/// Returns a remark as a sentence.
pub(crate) fn words(remark: &Remark, language: Language) -> String {
    let fill = |text: Text, values: &[(&str, String)]| {
        let values: Vec<(&str, &str)> = values.iter().map(|(name, value)| (*name, value.as_str())).collect();
        text.filled(language, &values)
    };
    let fixed = |value: f64, decimals: usize| Number::fixed(value, decimals).text(language);
    let exact = |value: f64| Number::exact(value).text(language);
    let chance = |p: f64| ("p", Number::scientific(p, 2).text(language));
    let grade = |p: f64| ("grade", if p < OUTLIER { texts::OUTLIER } else { texts::STRAGGLER }.words(language));
    match remark {
        Remark::Worse(at) => {
            let ratio = ("ratio", fixed(at.ratio, 1));
            let values = [grade(at.probability), ("index", at.index.to_string()), ratio, chance(at.probability)];
            fill(texts::WORSE, &values)
        }
        Remark::Outlier(out) => {
            let values = [
                grade(out.probability),
                ("index", out.index.to_string()),
                ("run", out.run.to_string()),
                ("residual", fixed(out.residual_arcsec, 2)),
                ("axis", AXES[out.axis].to_owned()),
                chance(out.probability),
                ("line", out.line.map_or_else(String::new, |line| line.to_string())),
            ];
            fill(if out.line.is_some() { texts::OUTLIER_IN_LINE } else { texts::OUTLIER_READING }, &values)
        }
        Remark::BumpedRun(at) => {
            let values = [
                grade(at.probability),
                ("run", at.run.to_string()),
                ("turn", fixed(at.turn_arcsec, 2)),
                ("axis", axis_of_run(at, language)),
                ("mean", fixed(at.in_the_mean_arcsec.abs(), 2)),
                chance(at.probability),
            ];
            fill(if at.is_of_the_base() { texts::BUMPED_RUN_BASE } else { texts::BUMPED_RUN_PLATFORM }, &values)
        }
        Remark::TwoRuns(one, other) => fill(texts::TWO_RUNS, &[("one", one.to_string()), ("other", other.to_string())]),
        Remark::NotCompared => fill(texts::NOT_COMPARED, &[]),
        Remark::Twins(one, other) => fill(texts::TWINS, &[("one", one.to_string()), ("other", other.to_string())]),
        Remark::AxesDiffer(p) => fill(texts::AXES_DIFFER, &[chance(*p)]),
        Remark::FewRuns { runs, degrees_of_freedom: freedom } => {
            let doubt = fixed(Remark::doubt_percent(*freedom), 0);
            fill(texts::FEW_RUNS, &[("runs", runs.to_string()), ("freedom", freedom.to_string()), ("doubt", doubt)])
        }
        Remark::BaseAxes(0) => fill(texts::BASE_NOT_SEEN, &[]),
        Remark::BaseAxes(axes) => fill(texts::BASE_IN_PART, &[("axes", axes.to_string())]),
        Remark::SmallAngles(largest) => fill(texts::SMALL_ANGLES, &[("largest", fixed(*largest, 2))]),
        Remark::Odd(Odd::FarAngle { angle, index, arcsec, usual_arcsec }) => {
            let values = [
                ("angle", ["α", "β", "γ"][*angle].to_owned()),
                ("index", index.to_string()),
                ("value", exact(*arcsec)),
                ("usual", exact(*usual_arcsec)),
            ];
            fill(texts::FAR_ANGLE, &values)
        }
        Remark::Odd(Odd::Temperature { celsius, .. }) => fill(texts::TEMPERATURE, &[("value", exact(*celsius))]),
        Remark::Odd(Odd::OldMeasurement { performed, issued }) => fill(
            texts::OLD_MEASUREMENT,
            &[("performed", date_text(language, *performed)), ("issued", date_text(language, *issued))],
        ),
        Remark::Odd(Odd::LongValidity { valid_until, issued }) => fill(
            texts::LONG_VALIDITY,
            &[("until", date_text(language, *valid_until)), ("issued", date_text(language, *issued))],
        ),
        Remark::Odd(Odd::OutsideRange { celsius, range: [low, high] }) => {
            fill(texts::OUTSIDE_RANGE, &[("value", exact(*celsius)), ("low", exact(*low)), ("high", exact(*high))])
        }
    }
}

/// Returns the name of the axis about which a run is rotated, without platform or base.
pub(super) fn axis_of_run(at: &BumpedRun, language: Language) -> String {
    match at.axis {
        axis @ 0..3 => AXES[axis].to_owned(),
        axis => [terms::EAST, terms::NORTH, terms::UP][axis - 3].words(language),
    }
}

/// Returns a finding of a comparison with the last certificate as a sentence.
pub(crate) fn finding(finding: &Finding, language: Language) -> String {
    let text = match finding {
        Finding::Changed(ComparedPosition { index, turn_arcsec, .. }) => {
            let [x, y, z] = turn_arcsec.map(|value| Number::fixed(value, 2).text(language));
            let index = index.to_string();
            let values = [("index", index.as_str()), ("x", &x), ("y", &y), ("z", &z)];
            return texts::POSITION_CHANGED.filled(language, &values);
        }
        Finding::BumpedRun(at) => {
            let [turn, mean] =
                [at.turn_arcsec, at.in_the_mean_arcsec].map(|value| Number::fixed(value, 2).text(language));
            let (run, axis) = (at.run.to_string(), axis_of_run(at, language));
            let text = if at.is_of_the_base() { texts::CHECK_BUMPED_BASE } else { texts::CHECK_BUMPED_PLATFORM };
            return text.filled(language, &[("run", &run), ("turn", &turn), ("axis", &axis), ("mean", &mean)]);
        }
        Finding::Outlier(out, mean) => {
            let [residual, mean] = [out.residual_arcsec, *mean].map(|value| Number::fixed(value, 2).text(language));
            let (index, run) = (out.index.to_string(), out.run.to_string());
            let values =
                [("index", &*index), ("run", &run), ("residual", &residual), ("axis", AXES[out.axis]), ("mean", &mean)];
            return texts::CHECK_OUTLIER.filled(language, &values);
        }
        Finding::AnotherStand => texts::ANOTHER_STAND,
        Finding::ChangedTogether => texts::CHANGED_TOGETHER,
        Finding::Slightly => texts::CHANGED_SLIGHTLY,
        Finding::Rotated => texts::ROTATED,
        Finding::RotatedSlightly => texts::ROTATED_SLIGHTLY,
        Finding::NotTested(Untested::Variation) => texts::NOT_TESTED_VARIATION,
        Finding::NotTested(Untested::NumberOfRuns) => texts::NOT_TESTED_RUNS,
        Finding::NotTested(Untested::CommonParts) => texts::NOT_TESTED_COMMON_PARTS,
        Finding::TreatedAsExact => texts::TREATED_AS_EXACT,
        Finding::SameReadings => texts::SAME_READINGS,
        Finding::TooClose => texts::TOO_CLOSE,
    };
    text.words(language)
}
