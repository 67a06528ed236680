//! Why a channel stops: the first cause that its outputs name.

use crate::families::Said;
use crate::recording::Value;

/// The reason in words.
pub(super) fn reason(said: &Said<'_>) -> String {
    let value = |name: &str| (said.value)(name, 0);
    let stop = said.text("stop");
    let alarms = said.text("alarms");
    let alarm = |number: &str| alarms.split(' ').any(|a| a == number);
    let of = |nck: &str, drive: &str, words: &str| {
        let number = if said.side == 0 { nck } else { drive };
        alarm(number).then(|| format!("{words} (alarm {number})"))
    };
    let code = match value("fault_code") {
        Some(Value::Int(code)) if code > 0 => format!(", code {code}"),
        _ => String::new(),
    };
    let found = match stop.as_str() {
        "F" => of("27001", "300911", &format!("cross comparison{code}")),
        "TEST" => Some("test of the shutdown path".to_owned()),
        "B" if said.text("stop_phase") == "B_BRAKING" && !alarm("27010") && !alarm("300907") => {
            matches!(value("fault"), Some(Value::Bool(true)))
                .then(|| "the delay after STOP F has passed".to_owned())
        }
        _ => None,
    };
    found
        .or_else(|| of("27013", "300906", "braking ramp exceeded"))
        .or_else(|| of("27010", "300907", "standstill tolerance exceeded"))
        .or_else(|| of("27011", "300914", "speed limit exceeded"))
        .or_else(|| of("27012", "300915", "limit position passed"))
        .or_else(|| of("27001", "300911", &format!("cross comparison{code}")))
        .or_else(|| {
            let started = value("spl_started") != Some(Value::Bool(false));
            (!started && stop == "A").then(|| "the safe logic has not been started".to_owned())
        })
        .or_else(|| {
            (said.text("stop_external") == stop).then(|| "asked for by a signal".to_owned())
        })
        .or_else(|| {
            let earlier = (said.value)("stop", 1)?;
            (stop == "A" && earlier == Value::Text("B".into()))
                .then(|| "STOP B has ended".to_owned())
        })
        .unwrap_or_else(|| "told by the other channel".to_owned())
}
