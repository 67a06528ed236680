//! Examples for the rules about what an F module reads or switches: a guarantee about it needs its time-out.

use super::Example;

/// The rule by its text, the pattern, what stands in the guarantee beside the signal, the signal, its time-out.
const RULES: [(&str, &str, &str, &str, &str); 8] = [
    (
        "the contact that asks for the stop comes from an F module",
        "stop_request",
        "stop = \"STOP A\", within = \"1 s\", signal = \"112 ms\"",
        "contact = \"INSE[4]\"",
        "bus_timeout",
    ),
    (
        "the contact of the emergency stop comes from an F module",
        "torque_off",
        "within = \"1 s\", signal = \"112 ms\"",
        "contact = \"INSE[4]\"",
        "bus_timeout",
    ),
    (
        "the enabling device comes from an F module",
        "enabling",
        "door = \"front\", within = \"1 s\", signal = \"112 ms\"",
        "enabling = \"INSE[4]\"",
        "device_timeout",
    ),
    (
        "the contact behind which the key acknowledges comes from an F module",
        "reset",
        "key = \"INSE[5]\"",
        "contact = \"INSE[4]\"",
        "bus_timeout",
    ),
    (
        "the key that acknowledges comes from an F module",
        "reset",
        "contact = \"INSE[5]\"",
        "key = \"INSE[1]\"",
        "bus_timeout",
    ),
    (
        "the key that starts comes from an F module",
        "no_start",
        "door = \"front\"",
        "key = \"INSE[4]\"",
        "",
    ),
    (
        "the mode comes from an F module",
        "travel_limits",
        "from = \"-99 mm\", to = \"99 mm\", reaches = \"1 mm/min\", within = \"1 s\", signal = \"112 ms\"",
        "mode = \"INSE[4]\"",
        "bus_timeout",
    ),
    (
        "the contactors are switched by an F module",
        "contactor",
        "feedback = \"INSE[7]\", within = \"1 s\"",
        "coil = \"OUTSE[4]\"",
        "bus_timeout",
    ),
];

/// Rules about a value that is too small: the rule by its text, the pattern, what stands in the guarantee, what is wrong and what is right.
const VALUES: [(&str, &str, &str, &str, &str); 6] = [
    (
        "the signal comes from an F module, and takes longer",
        "stop_request",
        "stop = \"STOP A\", within = \"1 s\", contact = \"INSE[4]\", bus_timeout = \"150 ms\"",
        "signal = \"111 ms\"",
        "signal = \"112 ms\"",
    ),
    (
        "one of the two contacts may be stuck",
        "stop_request",
        "stop = \"STOP A\", within = \"1 s\", contact = \"INSE[5]\", contacts = 2, after = \"any single fault of a channel or contact\"",
        "discrepancy = \"0 ms\"",
        "discrepancy = \"1 ms\"",
    ),
    (
        "one of the two contacts of the device may be stuck",
        "enabling",
        "door = \"front\", within = \"1 s\", enabling = \"INSE[5]\", device_contacts = 2, after = \"any single fault of a channel or contact\"",
        "device_discrepancy = \"0 ms\"",
        "device_discrepancy = \"1 ms\"",
    ),
    (
        "the contactors are switched by an F module, and its data alone may come later than that",
        "contactor",
        "feedback = \"INSE[7]\", coil = \"OUTSE[4]\", bus_timeout = \"150 ms\"",
        "within = \"100 ms\"",
        "within = \"1 s\"",
    ),
    (
        "in that time the axis goes on further than is promised",
        "stop_request",
        "stop = \"STOP A\", within = \"1 s\", contact = \"INSE[5]\"",
        "travel = \"44.332 mm\"",
        "travel = \"44.333 mm\"",
    ),
    (
        "the axis does not feed this signal with its \"n < n_x\"",
        "guard_lock",
        "door = \"front\", unlock = \"OUTSE[5]\"",
        "standstill = \"INSI[1]\"",
        "standstill = \"INSE[8]\"",
    ),
];

/// A machine with a module for the first four inputs and outputs, and the guarantee.
fn machine(pattern: &str, guarantee: &str, door: &str) -> String {
    let rest = ", 0".repeat(15);
    let axes = match guarantee.contains("door") {
        true => "",
        false => "axes = [\"Y\"], ",
    };
    format!(
        "control = {{ SYSCLOCK_CYCLE_TIME = \"4 ms\", SAFETY_SYSCLOCK_TIME_RATIO = 3, IPO_SYSCLOCK_CYCLE_TIME_RATIO = 3, PLC_CYCLE_MAX = \"50 ms\", PROFISAFE_MASTER_ADDRESS = 0x050007D2, \
         PROFISAFE_IN_ADDRESS = [0x050003FE{rest}], PROFISAFE_IN_ASSIGN = [4001{rest}], PROFISAFE_OUT_ADDRESS = [0x050003FE{rest}], PROFISAFE_OUT_ASSIGN = [4001{rest}] }}\n\
         axis.Y = {{ kind = \"linear\", functions = [\"SBH/SG\", \"external stops\"], SS_DISABLE_INPUT = \"OUTSI[3]\", VELO_SELECT_INPUT = [\"OUTSI[4]\", \"OUTSI[5]\"], EXT_STOP_INPUT = [\"OUTSI[1]\", \"OUTSI[2]\", \"1\", \"1\"] }}\n\
         door.front = {{ axes = [\"Y\"], contact = \"INSE[9]\"{door} }}\n\
         logic.spl = {{ source = \"../../tests/machines/press-840d.spf\" }}\n\
         guarantee.asked = {{ pattern = \"{pattern}\", {axes}{guarantee} }}"
    )
}

pub(super) fn examples() -> Vec<Example> {
    let all = RULES.iter().map(|(rule, pattern, others, signal, time)| {
        let without = format!("{others}, {signal}");
        let bad = machine(pattern, &without, "");
        let good = match *time {
            "" => machine(pattern, &without, ", bus_timeout = \"150 ms\""),
            time => machine(pattern, &format!("{without}, {time} = \"150 ms\""), ""),
        };
        (*rule, bad, good)
    });
    let values = VALUES.iter().map(|(rule, pattern, others, bad, good)| {
        let with = |value: &str| machine(pattern, &format!("{others}, {value}"), "");
        (*rule, with(bad), with(good))
    });
    all.chain(values).chain(of_axes()).collect()
}

/// Rules about a guarantee and an input or output of its axis.
fn of_axes() -> [Example; 3] {
    let way = "stop = \"STOP A\", within = \"1 s\", contact = \"INSE[5]\", travel = \"44.333 mm\"";
    let way = machine("stop_request", way, "");
    let free = "SVSS_DISABLE_INPUT = \"OUTSI[6]\", SS_DISABLE_INPUT";
    let lock = "door = \"front\", unlock = \"OUTSE[5]\", standstill = \"INSI[1]\", speed = \"20 mm/min\", after = \"any single fault of a channel or contact\"";
    let fed = "VELO_X_STATUS_OUTPUT = \"INSI[1]\", SS_DISABLE_INPUT";
    let lock = machine("guard_lock", lock, "").replace("SS_DISABLE_INPUT", fed);
    let delay = "SAFE_PULSE_DIS_TIME_BUSFAIL = \"12 ms\", PLC_CYCLE_MAX";
    [
        (
            "SBH/SG of the axis may be de-selected",
            way.replace("SS_DISABLE_INPUT", free),
            way,
        ),
        (
            "the lock waits for \"n < n_x\", which stays as it was",
            lock.replace("PLC_CYCLE_MAX", delay),
            lock.clone(),
        ),
        (
            "the lock waits for \"n < n_x\", and n_x (",
            lock.replace("20 mm/min", "19 mm/min"),
            lock,
        ),
    ]
}
