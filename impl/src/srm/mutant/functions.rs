//! Wrong variants of the functions without a state.

use crate::srm::dint::Outcome;
use crate::srm::{interpolation, min_max};

variants! { srm::add_dint:
    /// A sum that is no DInt wraps.
    "add-dint-wraps" |state, _config, inputs| {
        (state, Outcome::of(Some(inputs.operand1.wrapping_add(inputs.operand2))))
    }

    /// A sum that is no DInt leaves the end of the range beside the flag.
    "add-dint-saturates" |state, _config, inputs| {
        let sum = inputs.operand1.checked_add(inputs.operand2);
        let result = inputs.operand1.saturating_add(inputs.operand2);
        (state, Outcome { result, overflow: sum.is_none() })
    }
}

variants! { srm::sub_dint:
    /// A difference that is no DInt wraps.
    "sub-dint-wraps" |state, _config, inputs| {
        (state, Outcome::of(Some(inputs.operand1.wrapping_sub(inputs.operand2))))
    }

    /// The operands are exchanged.
    "sub-dint-exchanged" |state, _config, inputs| {
        (state, Outcome::of(inputs.operand2.checked_sub(inputs.operand1)))
    }
}

variants! { srm::mul_dint:
    /// A product that is no DInt wraps.
    "mul-dint-wraps" |state, _config, inputs| {
        (state, Outcome::of(Some(inputs.operand1.wrapping_mul(inputs.operand2))))
    }

    /// The least DInt is no product.
    "mul-dint-loses-an-end" |state, _config, inputs| {
        let product = inputs.operand1.checked_mul(inputs.operand2);
        (state, Outcome::of(product.filter(|product| *product != i32::MIN)))
    }
}

variants! { srm::div_dint:
    /// Quotients are rounded down.
    "div-dint-rounds-down" |state, _config, inputs| {
        let (a, b) = (inputs.operand1, inputs.operand2);
        let down = a.checked_div(b).map(|quotient| {
            if a % b != 0 && (a < 0) != (b < 0) { quotient - 1 } else { quotient }
        });
        (state, Outcome::of(down))
    }

    /// A division by 0 gives 0 without a word.
    "div-dint-by-zero" |state, _config, inputs| {
        let quotient = inputs.operand1.checked_div(inputs.operand2);
        let overflow = quotient.is_none() && inputs.operand2 != 0;
        (state, Outcome { result: quotient.unwrap_or(0), overflow })
    }

    /// The quotient above the greatest DInt is cut.
    "div-dint-saturates" |state, _config, inputs| {
        let quotient = match inputs.operand2 {
            0 => None,
            divisor => Some(inputs.operand1.saturating_div(divisor)),
        };
        (state, Outcome::of(quotient))
    }
}

variants! { srm::min_max:
    /// The last operand is not looked at.
    "min-max-of-seven" |state, config, inputs| {
        let inputs = min_max::Inputs { in8: inputs.in7, ..*inputs };
        min_max::transition(state, config, &inputs)
    }

    /// The least is looked for by magnitude.
    "min-max-by-magnitude" |state, config, inputs| {
        let (_, mut outputs) = min_max::transition(state, config, inputs);
        if !inputs.mode {
            let least = inputs.operands().into_iter().min_by_key(|operand| operand.unsigned_abs());
            outputs.q = least.unwrap_or(0);
        }
        (state, outputs)
    }

    /// An operand of 0 counts as not connected.
    "min-max-skips-zero" |state, _config, inputs| {
        let connected = inputs.operands().into_iter().filter(|operand| *operand != 0);
        let found = if inputs.mode { connected.max() } else { connected.min() };
        (state, min_max::Outputs { q: found.unwrap_or(0) })
    }
}

variants! { srm::interpolation:
    /// Points that do not ascend are taken as they are.
    "interpolation-unchecked" |state, config, inputs| {
        let (_, mut outputs) = interpolation::transition(state, config, inputs);
        if !config.curve.ascends() {
            outputs.error = false;
        }
        (state, outputs)
    }

    /// Between two points the velocity of the second one holds: steps, always on the side of more.
    "interpolation-steps" |state, config, inputs| {
        let (_, mut outputs) = interpolation::transition(state, config, inputs);
        let points = config.curve.points();
        let next = points.iter().find(|point| point.0 >= inputs.x_actual);
        if let (false, Some(point)) = (outputs.error, next) {
            outputs.v_limit = point.1;
        }
        (state, outputs)
    }

    /// Of points with the same place the last one counts.
    "interpolation-last-of-equals" |state, config, inputs| {
        let (_, mut outputs) = interpolation::transition(state, config, inputs);
        let points = config.curve.points();
        let last = points.iter().rev().find(|point| point.0 == inputs.x_actual);
        if let (false, Some(point)) = (outputs.error, last) {
            outputs.v_limit = point.1;
        }
        (state, outputs)
    }

    /// Behind the last point nothing limits.
    "interpolation-open-end" |state, config, inputs| {
        let (_, mut outputs) = interpolation::transition(state, config, inputs);
        if !outputs.error && inputs.x_actual > config.curve.x_16 {
            outputs.v_limit = i32::MAX;
        }
        (state, outputs)
    }

    /// The line is rounded up.
    "interpolation-rounds-up" |state, config, inputs| {
        let (_, mut outputs) = interpolation::transition(state, config, inputs);
        let at = config.curve.points().iter().any(|point| point.0 == inputs.x_actual);
        let inside = config.curve.x[0] < inputs.x_actual && inputs.x_actual < config.curve.x_16;
        if !outputs.error && !at && inside {
            outputs.v_limit = outputs.v_limit.saturating_add(1);
        }
        (state, outputs)
    }

    /// An error leaves the highest velocity.
    "interpolation-error-permits" |state, config, inputs| {
        let (_, mut outputs) = interpolation::transition(state, config, inputs);
        if outputs.error {
            outputs.v_limit = config.curve.v_16;
        }
        (state, outputs)
    }
}
