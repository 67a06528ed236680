//! Machines of the 840D family that break one rule each, and machines beside them that keep it.

/// For each rule a machine that violates it and one beside it that does not: what stands in the file after the family.
pub(super) const EXAMPLES: [(&str, &str, &str); 77] = [
    (
        "the monitoring cycle is longer than 25 ms",
        "control.SYSCLOCK_CYCLE_TIME = \"5 ms\"\ncontrol.SAFETY_SYSCLOCK_TIME_RATIO = 6\naxis.X = { kind = \"linear\" }",
        "control.SYSCLOCK_CYCLE_TIME = \"5 ms\"\ncontrol.SAFETY_SYSCLOCK_TIME_RATIO = 5\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the axis is connected to the safe programmable logic, whose halves may differ",
        "control = { SYSCLOCK_CYCLE_TIME = \"4 ms\", IPO_SYSCLOCK_CYCLE_TIME_RATIO = 3, PLC_CYCLE_MAX = \"988 ms\" }\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"external stops\"], EXT_STOP_INPUT = [\"OUTSI[1]\", \"1\", \"1\", \"1\"], MODE_SWITCH_TIME = \"2 s\" }",
        "control = { SYSCLOCK_CYCLE_TIME = \"4 ms\", IPO_SYSCLOCK_CYCLE_TIME_RATIO = 3, PLC_CYCLE_MAX = \"987 ms\" }\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"external stops\"], EXT_STOP_INPUT = [\"OUTSI[1]\", \"1\", \"1\", \"1\"], MODE_SWITCH_TIME = \"2 s\" }",
    ),
    (
        "the message is suppressed while the axis is parked",
        "axis.X = { kind = \"linear\", PARK_ALARM_SUPPRESS = true }",
        "axis.X = { kind = \"linear\", PARK_ALARM_SUPPRESS = true, REFP_STATUS_ASSIGNED = true }",
    ),
    (
        "each changeover of the drive loses the absolute position",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"SE\"], SETPOINT_CHANGEOVER = true }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], SETPOINT_CHANGEOVER = true }",
    ),
    (
        "on a drive that is changed over a stop must act on all axes",
        "axis.X = { kind = \"linear\", SETPOINT_CHANGEOVER = true, IPO_STOP_GROUP = \"interpolating axes\" }",
        "axis.X = { kind = \"linear\", SETPOINT_CHANGEOVER = true }",
    ),
    (
        "a kept actual value of an incremental encoder is not permitted",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"SE\"], SAVED_ACTUAL_VALUE = true, MOTOR_ENCODER = \"incremental\" }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"SE\"], SAVED_ACTUAL_VALUE = true, MOTOR_ENCODER = \"absolute\" }",
    ),
    (
        "the monitoring cycle is no multiple of the position-control cycle",
        "control.POSCTRL_SYSCLOCK_TIME_RATIO = 2\naxis.X = { kind = \"linear\" }",
        "control.POSCTRL_SYSCLOCK_TIME_RATIO = 3\ncontrol.IPO_SYSCLOCK_CYCLE_TIME_RATIO = 3\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the interpolator cycle is no multiple of the position-control cycle",
        "control.POSCTRL_SYSCLOCK_TIME_RATIO = 3\ncontrol.IPO_SYSCLOCK_CYCLE_TIME_RATIO = 4\naxis.X = { kind = \"linear\" }",
        "control.POSCTRL_SYSCLOCK_TIME_RATIO = 3\ncontrol.IPO_SYSCLOCK_CYCLE_TIME_RATIO = 6\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the position-control cycle is longer than 16 ms",
        "control.SYSCLOCK_CYCLE_TIME = \"16.125 ms\"\ncontrol.SAFETY_SYSCLOCK_TIME_RATIO = 1\naxis.X = { kind = \"linear\" }",
        "control.SYSCLOCK_CYCLE_TIME = \"16 ms\"\ncontrol.SAFETY_SYSCLOCK_TIME_RATIO = 1\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the drive cannot hold the monitoring cycle",
        "control.SYSCLOCK_CYCLE_TIME = \"3.333 ms\"\naxis.X = { kind = \"linear\" }",
        "control.SYSCLOCK_CYCLE_TIME = \"3.375 ms\"\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the contact of the door has the time-out of an F module, and there is none",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"] }\ndoor.A = { axes = [\"X\"], bus_timeout = \"100 ms\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"] }\ndoor.A = { axes = [\"X\"], contact = \"INSE[4]\", bus_timeout = \"100 ms\" }",
    ),
    (
        "the contact of the door comes from an F module",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"] }\ndoor.A = { axes = [\"X\"], contact = \"INSE[4]\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"] }\ndoor.A = { axes = [\"X\"], contact = \"INSE[5]\" }",
    ),
    (
        "the time-out of the F module is shorter than the PROFIsafe cycle",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"] }\ndoor.A = { axes = [\"X\"], contact = \"INSE[4]\", bus_timeout = \"1 ms\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"] }\ndoor.A = { axes = [\"X\"], contact = \"INSE[4]\", bus_timeout = \"150 ms\" }",
    ),
    (
        "the PROFIsafe cycle is longer than 25 ms",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IPO_TIME_RATIO = 2\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_IPO_TIME_RATIO = 2\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the bus segment of the F master is not 5",
        "control.PROFISAFE_MASTER_ADDRESS = 0x040007D2\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\naxis.X = { kind = \"linear\" }",
    ),
    (
        "F modules are connected to an F master without an address",
        "control.PROFISAFE_MASTER_ADDRESS = 0x05000000\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the bus segment of an input connection is not 5",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x040003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "an input connection has no PROFIsafe address",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x05000000]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x05000001]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "an input connection has no PROFIsafe address",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an input connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an input connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1002]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2002]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an input connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 64000]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 64057]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an input connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the data block in the PLC is that of axis",
        "axis.X = { kind = \"linear\", machine_axis = 2 }\naxis.Y = { kind = \"linear\", machine_axis = 2 }",
        "axis.X = { kind = \"linear\", machine_axis = 2 }\naxis.Y = { kind = \"linear\", machine_axis = 1 }",
    ),
    (
        "a variable belongs to two input connections",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 8004, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 8005, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable belongs to two input connections",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [8005, 0, 0, 0, 0, 0, 0, 0, 0, 5001, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [8005, 0, 0, 0, 0, 0, 0, 0, 0, 4001, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an input connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.SAFE_IN_HW_ASSIGN = [0x01020101, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.SAFE_IN_HW_ASSIGN = [0, 0x01020101, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an input connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8008]\ncontrol.SAFE_IN_HW_ASSIGN = [0x01020101, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9009]\ncontrol.SAFE_IN_HW_ASSIGN = [0x01020101, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an input connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5002]\ncontrol.SAFE_IN_HW_ASSIGN = [2, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5002]\ncontrol.SAFE_IN_HW_ASSIGN = [1, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an input connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 12012]\ncontrol.SAFE_IN_HW_ASSIGN = [0, 8, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 12012]\ncontrol.SAFE_IN_HW_ASSIGN = [0, 7, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the filter of an input connection chooses another number",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_IN_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0x000F001F]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_IN_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0x80010011]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the filter of an input connection chooses another number",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_IN_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0x7FFFFFFF]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_IN_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_IN_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the bus segment of an output connection is not 5",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x040003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "an output connection has no PROFIsafe address",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x05000000]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x05000001]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "an output connection has no PROFIsafe address",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an output connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9001]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an output connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1002]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2002]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an output connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 64000]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 64057]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the variables of an output connection are no row",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1001]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable belongs to two output connections",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_OUT_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 8004, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_OUT_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 8005, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable belongs to two output connections",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_OUT_ASSIGN = [8005, 0, 0, 0, 0, 0, 0, 0, 0, 5001, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_OUT_ASSIGN = [8005, 0, 0, 0, 0, 0, 0, 0, 0, 4001, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an output connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.SAFE_OUT_HW_ASSIGN = [0x01020101, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.SAFE_OUT_HW_ASSIGN = [0, 0x01020101, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an output connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8008]\ncontrol.SAFE_OUT_HW_ASSIGN = [0x01020101, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9009]\ncontrol.SAFE_OUT_HW_ASSIGN = [0x01020101, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an output connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5002]\ncontrol.SAFE_OUT_HW_ASSIGN = [2, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5002]\ncontrol.SAFE_OUT_HW_ASSIGN = [1, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a variable of an output connection belongs to a module of the NCK",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 12012]\ncontrol.SAFE_OUT_HW_ASSIGN = [0, 8, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 12012]\ncontrol.SAFE_OUT_HW_ASSIGN = [0, 7, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the filter of an output connection chooses another number",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_OUT_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0x000F001F]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_OUT_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0x80010011]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "the filter of an output connection chooses another number",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_OUT_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0x7FFFFFFF]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x050003FE]\ncontrol.PROFISAFE_OUT_ASSIGN = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4001]\ncontrol.PROFISAFE_OUT_FILTER = [0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "an input connection uses another sub-slot than 0",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050103FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_OUT_ADDRESS = [0x050103FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_OUT_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\naxis.X = { kind = \"linear\" }",
    ),
    (
        "a connection uses variables that the option SI-Basic does not have",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [5002, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.SI_BASIC = true\naxis.X = { kind = \"linear\" }",
        "control.PROFISAFE_MASTER_ADDRESS = 0x050007D2\ncontrol.PROFISAFE_IN_ADDRESS = [0x050003FE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.PROFISAFE_IN_ASSIGN = [4001, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\ncontrol.SI_BASIC = true\naxis.X = { kind = \"linear\" }",
    ),
    (
        "functions are enabled without \"SBH/SG\"",
        "axis.X = { kind = \"linear\", functions = [\"SE\"] }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"SE\"] }",
    ),
    (
        "\"STOP E\" is enabled without \"external stops\"",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"STOP E\"] }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"STOP E\", \"external stops\"] }",
    ),
    (
        "errors of the safe programmable logic ask for STOP E",
        "control.SAFE_SPL_STOP_MODE = \"STOP E\"\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"external stops\"] }",
        "control.SAFE_SPL_STOP_MODE = \"STOP E\"\naxis.X = { kind = \"linear\" }",
    ),
    (
        "\"slip sync\" makes the absolute position meaningless",
        "axis.X = { kind = \"linear\", LOAD_ENCODER = \"incremental\", functions = [\"SBH/SG\", \"slip sync\", \"SN3-\"] }",
        "axis.X = { kind = \"linear\", LOAD_ENCODER = \"incremental\", functions = [\"SBH/SG\", \"slip sync\"] }",
    ),
    (
        "\"slip sync\" needs two encoders",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"slip sync\"] }",
        "axis.X = { kind = \"linear\", LOAD_ENCODER = \"incremental\", functions = [\"SBH/SG\", \"slip sync\"] }",
    ),
    (
        "the axis has no encoder at the motor",
        "axis.X = { kind = \"linear\", MOTOR_ENCODER = \"none\", LOAD_ENCODER = \"absolute\", functions = [\"SBH/SG\"] }",
        "axis.X = { kind = \"linear\", MOTOR_ENCODER = \"incremental\", LOAD_ENCODER = \"absolute\", functions = [\"SBH/SG\"] }",
    ),
    (
        "the axis has no encoder at the motor",
        "axis.X = { kind = \"linear\", MOTOR_ENCODER = \"none\", functions = [\"SBH/SG\"] }",
        "axis.X = { kind = \"linear\", MOTOR_ENCODER = \"absolute\", functions = [\"SBH/SG\"] }",
    ),
    (
        "two encoders with slip between them drift apart",
        "axis.S = { kind = \"spindle\", SLIP = true, LOAD_ENCODER = \"incremental\", functions = [\"SBH/SG\"] }",
        "axis.S = { kind = \"spindle\", SLIP = true, LOAD_ENCODER = \"incremental\", functions = [\"SBH/SG\", \"slip sync\"] }",
    ),
    (
        "\"SE\" and \"SN\" are not permitted on an axis with slip",
        "axis.S = { kind = \"spindle\", SLIP = true, functions = [\"SBH/SG\", \"SN1+\"] }",
        "axis.S = { kind = \"spindle\", SLIP = true, functions = [\"SBH/SG\"] }",
    ),
    (
        "internal pulse cancellation has no external path",
        "axis.X = { kind = \"linear\", CONTROL_MODULE = \"Performance 2\", INTERNAL_PULSE_CANCELLATION = true, EXT_PULSE_ENABLE_ASSIGNED = true }",
        "axis.X = { kind = \"linear\", CONTROL_MODULE = \"Performance 2\", INTERNAL_PULSE_CANCELLATION = true, EXT_PULSE_ENABLE_ASSIGNED = true, EXT_PULSE_TEST_ASSIGNED = true }",
    ),
    (
        "internal pulse cancellation has no external path",
        "axis.X = { kind = \"linear\", CONTROL_MODULE = \"High Standard\", INTERNAL_PULSE_CANCELLATION = true, EXT_PULSE_TEST_ASSIGNED = true }",
        "axis.X = { kind = \"linear\", CONTROL_MODULE = \"High Standard\", EXT_PULSE_TEST_ASSIGNED = true }",
    ),
    (
        "this control module has no internal pulse cancellation",
        "axis.X = { kind = \"linear\", INTERNAL_PULSE_CANCELLATION = true, EXT_PULSE_ENABLE_ASSIGNED = true, EXT_PULSE_TEST_ASSIGNED = true }",
        "axis.X = { kind = \"linear\", CONTROL_MODULE = \"High Performance\", INTERNAL_PULSE_CANCELLATION = true, EXT_PULSE_ENABLE_ASSIGNED = true, EXT_PULSE_TEST_ASSIGNED = true }",
    ),
    (
        "this control module monitors encoders up to 300 kHz only",
        "axis.X = { kind = \"linear\", ENC_FREQ_LIMIT = \"301 kHz\", CONTROL_MODULE = \"Standard 2\" }",
        "axis.X = { kind = \"linear\", ENC_FREQ_LIMIT = \"420 kHz\", CONTROL_MODULE = \"Performance 2\" }",
    ),
    (
        "a speed limit lies above what the limit frequency of the encoder permits",
        "axis.C = { kind = \"rotary\", functions = [\"SBH/SG\"], VELO_LIMIT = [\"8789.063 rev/min\", \"0 rev/min\", \"0 rev/min\", \"0 rev/min\"] }",
        "axis.C = { kind = \"rotary\", functions = [\"SBH/SG\"], VELO_LIMIT = [\"8789.062 rev/min\", \"0 rev/min\", \"0 rev/min\", \"0 rev/min\"] }",
    ),
    (
        "a speed limit lies above what the limit frequency of the encoder permits",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], VELO_LIMIT = [\"0 mm/min\", \"87890.626 mm/min\", \"0 mm/min\", \"0 mm/min\"] }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], VELO_LIMIT = [\"0 mm/min\", \"87890.625 mm/min\", \"0 mm/min\", \"0 mm/min\"] }",
    ),
    (
        "a speed limit lies above what the limit frequency of the linear scale permits",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], ENC_IS_LINEAR = true, ENC_GRID_POINT_DIST = \"2 um\", VELO_LIMIT = [\"0 mm/min\", \"36001 mm/min\", \"0 mm/min\", \"0 mm/min\"] }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], ENC_IS_LINEAR = true, ENC_GRID_POINT_DIST = \"2 um\", VELO_LIMIT = [\"0 mm/min\", \"36000 mm/min\", \"0 mm/min\", \"0 mm/min\"] }",
    ),
    (
        "the drive cannot convert between the encoder and the load",
        "axis.C = { kind = \"rotary\", functions = [\"SBH/SG\"], ENC_RESOL = 43 }",
        "axis.C = { kind = \"rotary\", functions = [\"SBH/SG\"], ENC_RESOL = 44 }",
    ),
    (
        "the drive cannot convert between the encoder and the load",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], VELO_LIMIT = [\"1 mm/min\", \"1 mm/min\", \"1 mm/min\", \"1 mm/min\"], ENC_RESOL = 80000, ENC_GEAR_PITCH = \"9.999 mm/rev\" }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], VELO_LIMIT = [\"1 mm/min\", \"1 mm/min\", \"1 mm/min\", \"1 mm/min\"], ENC_RESOL = 79998, ENC_GEAR_PITCH = \"10 mm/rev\" }",
    ),
    (
        "the upper safe limit position does not lie above the lower one",
        "axis.X = { kind = \"linear\", POS_LIMIT_PLUS = [\"2 mm\", \"1 mm\"], POS_LIMIT_MINUS = [\"1 mm\", \"1 mm\"] }",
        "axis.X = { kind = \"linear\", POS_LIMIT_PLUS = [\"2 mm\", \"1.001 mm\"], POS_LIMIT_MINUS = [\"1 mm\", \"1 mm\"] }",
    ),
    (
        "the modulo range is no multiple of 360 deg",
        "axis.C = { kind = \"rotary\", MODULO_RANGE = \"361 deg\" }",
        "axis.C = { kind = \"rotary\", MODULO_RANGE = \"720 deg\" }",
    ),
    (
        "an enabled plus cam lies outside the modulo range",
        "axis.C = { kind = \"rotary\", MODULO_RANGE = \"360 deg\", functions = [\"SBH/SG\", \"SN1+\"], CAM_POS_PLUS = [\"0.098 deg\", \"0 deg\", \"0 deg\", \"0 deg\"] }",
        "axis.C = { kind = \"rotary\", MODULO_RANGE = \"360 deg\", functions = [\"SBH/SG\", \"SN1+\"], CAM_POS_PLUS = [\"0.099 deg\", \"0 deg\", \"0 deg\", \"0 deg\"] }",
    ),
    (
        "an enabled plus cam lies outside the modulo range",
        "axis.C = { kind = \"rotary\", functions = [\"SBH/SG\", \"SN4+\"], CAM_POS_PLUS = [\"0 deg\", \"0 deg\", \"0 deg\", \"737279.9 deg\"] }",
        "axis.C = { kind = \"rotary\", functions = [\"SBH/SG\", \"SN4+\"], CAM_POS_PLUS = [\"0 deg\", \"0 deg\", \"0 deg\", \"737279.899 deg\"] }",
    ),
    (
        "an enabled minus cam lies outside the modulo range",
        "axis.C = { kind = \"rotary\", MODULO_RANGE = \"360 deg\", functions = [\"SBH/SG\", \"cam sync\", \"SN2-\"], CAM_POS_MINUS = [\"0 deg\", \"359.8 deg\", \"0 deg\", \"0 deg\"] }",
        "axis.C = { kind = \"rotary\", MODULO_RANGE = \"360 deg\", functions = [\"SBH/SG\", \"SN2-\"], CAM_POS_MINUS = [\"0 deg\", \"359.8 deg\", \"0 deg\", \"0 deg\"] }",
    ),
    (
        "\"cam sync\" is enabled without a cam",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"cam sync\"] }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"cam sync\", \"SN4-\"] }",
    ),
    (
        "the tolerance time is shorter than two PLC cycles and one interpolator cycle",
        "control.PLC_CYCLE_MAX = \"50 ms\"\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"], MODE_SWITCH_TIME = \"115 ms\" }",
        "control.PLC_CYCLE_MAX = \"50 ms\"\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"], MODE_SWITCH_TIME = \"116 ms\" }",
    ),
    (
        "nothing monitors this axis while the door is open",
        "door.front.axes = [\"X\"]\naxis.X = { kind = \"linear\" }",
        "door.front.axes = [\"X\"]\naxis.X = { kind = \"linear\", functions = [\"SBH/SG\"] }\naxis.Y.kind = \"linear\"",
    ),
    (
        "the axis is connected to the safe programmable logic, which does not serve its external STOP A",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"external stops\"], SVSS_DISABLE_INPUT = \"OUTSI[1]\", EXT_STOP_INPUT = [\"NOT OUTSI[2]\", \"0\", \"0\", \"0\"] }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"external stops\"], SVSS_DISABLE_INPUT = \"OUTSI[1]\", EXT_STOP_INPUT = [\"OUTSI[2]\", \"0\", \"0\", \"0\"] }",
    ),
    (
        "the axis is connected to the safe programmable logic, but does not accept the stop",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\"], SVSS_DISABLE_INPUT = \"NOT OUTSI[1]\", EXT_STOP_INPUT = [\"OUTSI[2]\", \"0\", \"0\", \"0\"] }",
        "axis.X = { kind = \"linear\", functions = [\"SBH/SG\", \"external stops\"], SVSS_DISABLE_INPUT = \"NOT OUTSI[1]\", EXT_STOP_INPUT = [\"OUTSI[64]\", \"0\", \"0\", \"0\"] }",
    ),
];
