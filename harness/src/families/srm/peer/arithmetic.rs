//! The four operations on DInt: one table, four monitors.

use stillpoint_monitors::contract::Contract;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::srm::dint::{Operands, Outcome};
use stillpoint_monitors::srm::{add_dint, div_dint, mul_dint, sub_dint};

use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::{Made, Params, Refusal, chosen};
use crate::diff::product::Values;

/// The table, for each of its monitors.
pub(super) const MACHINES: &[(&str, &str)] = &[
    ("arithmetic", "add_dint"),
    ("arithmetic", "sub_dint"),
    ("arithmetic", "mul_dint"),
    ("arithmetic", "div_dint"),
];

/// Operands beside the ends of a DInt, beside the greatest squares in it, and beside 0.
const OPERANDS: Values = Values::List(&[
    -i32::MAX,
    1 - i32::MAX,
    -1_073_741_824,
    -46_341,
    -46_340,
    -3,
    -2,
    -1,
    0,
    1,
    2,
    3,
    46_340,
    46_341,
    1_073_741_824,
    i32::MAX - 1,
    i32::MAX,
]);

const OUTPUTS: &[&str] = &[
    "add",
    "add_overflow",
    "sub",
    "sub_overflow",
    "mul",
    "mul_overflow",
    "div",
    "div_overflow",
];

/// The step of a monitor that is a function of its operands.
type Operation = Box<dyn Fn(Operands) -> Outcome + Send + Sync>;

/// One of the monitors.
fn operation<M>(mutant: Option<Mutant>, config: M::Config) -> Operation
where
    M: Contract<Inputs = Operands, Outputs = Outcome>,
{
    let next = chosen::<M>(mutant);
    Box::new(move |operands| next(M::INITIAL, &config, &operands).1)
}

pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    if machine != "arithmetic" {
        return Ok(None);
    }
    if p.value("low") != -i32::MAX || p.value("high") != i32::MAX {
        return Err(Refusal::Table("a DInt of the monitors has 32 bits"));
    }
    let operations = [
        operation::<add_dint::Monitor>(mutant, add_dint::Config),
        operation::<sub_dint::Monitor>(mutant, sub_dint::Config),
        operation::<mul_dint::Monitor>(mutant, mul_dint::Config),
        operation::<div_dint::Monitor>(mutant, div_dint::Config),
    ];
    let adapter = Adapter::stateless(&["a", "b"], OUTPUTS, move |i, o| {
        let operands = Operands {
            operand1: i[0],
            operand2: i[1],
        };
        for operation in &operations {
            // The tables do not have the least DInt: as a result it is an overflow of theirs.
            let outcome = match operation(operands) {
                least if least.result == i32::MIN => Outcome::of(None),
                other => other,
            };
            o.extend([i64::from(outcome.result), i64::from(outcome.overflow)]);
        }
    });
    Ok(Some(adapter.explored(&["a", "b"], OPERANDS)))
}
