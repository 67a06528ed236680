//! The monitors of position and speed.

use stillpoint_model::Domain;
use stillpoint_monitors::heidenhain::{
    axis_count, comparison, deceleration, operating_stop, position_limit, revolutions, speed,
    stop_path,
};
use stillpoint_monitors::mutant::Mutant;

use crate::diff::peer::same::Same;
use crate::diff::peer::{Made, Params};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "speed" => Same::<speed::Monitor>::new(p, mutant)
            .named(&[
                ("limit_2", "limits.som_2"),
                ("limit_3", "limits.som_3"),
                ("limit_4", "limits.som_4"),
                ("limit_s", "limits.restricted"),
                ("with_2", "left.sls_2"),
                ("with_3", "left.sls_3"),
                ("with_4", "left.sls_4"),
                ("v", "speed"),
            ])
            .peer()?,
        "operating_stop" => Same::<operating_stop::Monitor>::new(p, mutant)
            .named(&[("v", "speed")])
            .peer()?,
        "stop_path" => Same::<stop_path::Monitor>::new(p, mutant).peer()?,
        "position_limit" => Same::<position_limit::Monitor>::new(p, mutant)
            .kept("last", "last")
            .peer()?,
        "revolutions" => {
            let turns = p.value("turns");
            Same::<revolutions::Monitor>::new(p, mutant)
                .cell(
                    "angle",
                    Domain {
                        lo: -turns - 1,
                        hi: turns + 1,
                    },
                )
                .without(&["moving"])
                .peer()?
        }
        "comparison" => Same::<comparison::Monitor>::new(p, mutant).peer()?,
        "deceleration" => Same::<deceleration::Monitor>::new(p, mutant)
            .named(&[("v", "speed")])
            .peer()?,
        // The table counts at most three axes: as many as may move without a limit.
        "axis_count" => Same::<axis_count::Monitor>::new(p, mutant)
            .named(&[("free", "ungrouped")])
            .hidden(&["one_only"])
            .told("allowed", |_, outputs| if outputs.one_only { 1 } else { 3 })
            .peer()?,
        _ => return Ok(None),
    }))
}
