//! The sentences about a cause: what it is, what to do, and what the parameters would be with it.

use super::{Finding, Kind, Scope};
use crate::calibration::Parameter;
use crate::coefficients::PositionIndex;
use crate::wording::number::{Number, Probability};
use crate::wording::texts::{finding as texts, units};
use crate::wording::words::{joined, listed, symbol, told};
use crate::wording::{BLANK, Words};

/// Significant digits of the parameters with a cause.
const DIGITS: i32 = 6;

impl Finding {
    /// Returns the sentences.
    pub(crate) fn said(&self) -> Words {
        let parameters = self.parameters.map(|parameters| {
            let values = parameters.to_vector();
            let each = Parameter::EIGHT
                .iter()
                .filter(|one| !values[one.place()].is_nan())
                .map(|one| joined([symbol(one.symbol()), told(Number::significant(values[one.place()], DIGITS))], " "));
            texts::parameters(listed(each))
        });
        let several = self.one_of_several.then(|| texts::ONE_OF_SEVERAL.into());
        joined([self.what()].into_iter().chain(several).chain(parameters), " ")
    }

    fn what(&self) -> Words {
        let (size, p) = (self.size.unwrap_or(f64::NAN), Probability(self.probability));
        let number = |digits| told(Number::significant(size, digits));
        let [x, y] = self.pair;
        let place = Number::place_of(x.abs().max(y.abs()));
        let pair = || [x, y].map(|one| told(Number::to_place(one, place)));
        let rates = || [x, y].map(|one| told(Number::scientific(one, 2)));
        let Scope { visit, row, cycle, .. } = self.scope;
        let index = || self.scope.index().map_or_else(|| "–".into(), Words::from);
        match self.kind {
            Kind::ColumnsExchanged => texts::columns_exchanged(self.place()),
            Kind::ColumnReversed => texts::column_reversed(self.place()),
            Kind::Range => texts::range(number(4), self.place()),
            Kind::GyroTurned => texts::gyro_turned(number(3), self.place()),
            Kind::Rotated => texts::rotated(number(2)),
            Kind::FrameAxis => texts::frame_axis(told(size)),
            Kind::OtherSite => {
                let (degrees, hemisphere) =
                    Number::fixed(size, 1).in_hemisphere([units::NORTH_LATITUDE, units::SOUTH_LATITUDE]);
                texts::other_site(vec![degrees.into(), format!("°{BLANK}").into(), hemisphere.into()])
            }
            Kind::Renumbered => {
                let numbers = self.scope.numbers.as_deref().unwrap_or("–");
                texts::renumbered(numbers.replace(" = ", &format!("{BLANK}={BLANK}")))
            }
            Kind::PositionsExchanged => texts::positions_exchanged(self.place()),
            Kind::TypeUnit => texts::type_unit(number(4)),
            Kind::KDiffers => texts::k_differs(number(2), p),
            Kind::TurnOnScatter => texts::turn_on_scatter(number(2), p),
            Kind::Drift => {
                let [x, y] = rates();
                match self.unit.as_deref() {
                    Some("deg/h/h") => texts::drift(x, y, p, "--drift"),
                    _ => texts::drift_in_order(x, y, p, "--drift"),
                }
            }
            Kind::Settling => {
                let [x, y] = rates();
                texts::settling(x, y, p)
            }
            Kind::GyroNoise => texts::gyro_noise(number(2), p, "noise.visit_deg_per_h"),
            Kind::GeneralModel => texts::general_model("--model general"),
            Kind::Backlash => texts::backlash(number(2), p),
            Kind::CoarseDigits => texts::coarse_digits(number(2)),
            Kind::Position => {
                let ([jx, jy], angle) = (pair(), number(2));
                texts::position(index(), angle, jx, jy)
            }
            Kind::Visit => {
                let [jx, jy] = pair();
                texts::visit(visit, index(), cycle, jx, jy, p)
            }
            Kind::Row => {
                let [jx, jy] = pair();
                texts::row(row, visit, index(), cycle, jx, jy, p)
            }
            Kind::RowsCorrelated => texts::rows_correlated(told(Number::fixed(size, 2))),
            Kind::Meter if self.unit.as_deref() == Some("mA") => texts::noisy_meter(number(2), p),
            Kind::Meter => texts::meter(number(2)),
            Kind::Stand => texts::stand(number(2)),
            Kind::Computed => texts::computed(p),
            Kind::Chance => texts::chance(told(Number::significant(1.0 / self.probability, 2))),
        }
    }

    /// Returns where the cause acts, in brackets; nothing if it acts everywhere.
    fn place(&self) -> Words {
        let Scope { cycle, channel, between, .. } = &self.scope;
        let index = |[i, j]: [u32; 2]| Words::from(PositionIndex { i, j });
        let each = [
            self.scope.index().map(|index| texts::at_position(Words::from(index))),
            between.map(|[one, other]| texts::at_positions(index(one), index(other))),
            cycle.map(texts::at_turn_on),
            channel.map(|channel| symbol(&format!("J_{channel}"))),
        ];
        let each: Vec<Words> = each.into_iter().flatten().collect();
        if each.is_empty() { "".into() } else { vec![" (".into(), listed(each), ")".into()].into() }
    }
}

impl Scope {
    /// Returns the position, if there is one.
    pub(crate) fn index(&self) -> Option<PositionIndex> {
        Some(PositionIndex { i: self.i?, j: self.j? })
    }
}
