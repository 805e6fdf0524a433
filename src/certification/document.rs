//! Certified stand file as text: canonical, with comments on the origin of its numbers.

use super::Certification;
use super::found::Scope;
use super::kind::Kind;
use crate::stand::{ActsOn, Stand};
use crate::text::Unreadable;
use crate::text::yaml::write_document;

impl Certification {
    /// Returns the stand file (`dtg-stand/1`), which is read back and compared first; `name` is its name in messages.
    ///
    /// # Errors
    /// Returns [`Unreadable`] if its reader refuses the file, for instance because a mean is outside the certifiable
    /// range.
    pub fn to_yaml(&self, name: &str) -> Result<String, Unreadable> {
        write_document(name, &self.stand, &|path| self.comments(path), Stand::from_yaml)
    }

    fn comments(&self, path: &str) -> Vec<String> {
        match path {
            "format" => vec!["Stand certified from repeated readings. Standard uncertainties (k = 1).".to_owned()],
            "certificate.repeatability_arcsec" => self.of_the_components(),
            "positions" => self.of_the_positions(),
            _ => Vec::new(),
        }
    }

    fn of_the_components(&self) -> Vec<String> {
        let components = &self.components;
        let own = components.own_arcsec2.map(|variance| format!("{:.3}", variance.value.sqrt()));
        let mut said = vec![
            format!(
                "Repeatability of one visit, from {} runs: {} arcsec about x, y, z.",
                self.runs.len(),
                own.join(", ")
            ),
            "It excludes the part common to all positions of a run; common_* are uncertainties of the mean of the \
             runs."
                .to_owned(),
        ];
        let platform = Some(&components.platform);
        for (what, common) in [("platform", platform), ("base", components.base.as_ref())] {
            said.push(match common {
                Some(common) if common.between_runs_arcsec2 > 0.0 => format!(
                    "The {what} varies by {:.3} arcsec per axis from run to run ({:.1} degrees of freedom).",
                    common.between_runs_arcsec2.sqrt(),
                    common.degrees_of_freedom
                ),
                Some(common) => format!(
                    "No variation of the {what} from run to run was found: at most {:.3} arcsec per axis at 95 %.",
                    common.upper_limit_arcsec2.sqrt()
                ),
                None => format!(
                    "A rotation of the {what} cannot be distinguished from one of the platform, which \
                     includes both."
                ),
            });
        }
        said
    }

    fn of_the_positions(&self) -> Vec<String> {
        let worse: Vec<String> = self
            .findings
            .iter()
            .filter_map(|found| match (found.kind, &found.scope) {
                (Kind::PositionScatter, Scope { position: Some(index), .. }) => Some(format!("position {index}")),
                (Kind::SettingScatter, Scope { theta_deg: Some(angle), .. }) => {
                    Some(format!("the positions with θ = {angle}°"))
                }
                (Kind::SettingScatter, Scope { phi_deg: Some(angle), .. }) => {
                    Some(format!("the positions with φ = {angle}°"))
                }
                _ => None,
            })
            .collect();
        let scatter = if worse.is_empty() {
            "the pooled standard deviation of all positions, for each axis".to_owned()
        } else {
            format!("for {} the own standard deviation, for the others the pooled one", worse.join(" and "))
        };
        let type_b = if self.stand.certificate.type_b_arcsec2(ActsOn::Position) > 0.0 { ", and type_b" } else { "" };
        let runs = self.runs.len();
        let mut said = vec![format!(
            "Means of {runs} runs. u_*: {scatter}, divided by the square root of the number \
             of runs{type_b}."
        )];
        said.extend(self.warnings.iter().map(|warning| format!("Warning: {warning}.")));
        said
    }
}
