//! Words of the Safety Info Channel, sent by the drive, and of the Safety Control Channel, received by it.

word! {
    /// S_ZSW1B, r9734 (S120-SIC-503).
    InfoWord1(u16) {
        /// STO is active.
        0 sto_active,
        /// SS1 is active.
        1 ss1_active,
        /// SS2 is active.
        2 ss2_active,
        /// SOS is active.
        3 sos_active,
        /// SLS is active.
        4 sls_active,
        /// SOS is selected.
        5 sos_selected,
        /// SLS is selected.
        6 sls_selected,
        /// Internal event.
        7 internal_event,
        /// Bit 0 of the active SLS level.
        9 sls_level_0,
        /// Bit 1 of the active SLS level.
        10 sls_level_1,
        /// SDI positive is selected.
        12 sdi_positive_selected,
        /// SDI negative is selected.
        13 sdi_negative_selected,
        /// ESR is requested.
        14 esr_requested,
        /// A safety message is effective.
        15 message_effective,
    }
}

word! {
    /// S_ZSW2B, r9743; with Extended Functions only (S120-SIC-504, S120-SIC-502, S120-TESTSTOP-516).
    InfoWord2(u16) {
        /// SLP area 2 is selected, else area 1.
        4 slp_area_2,
        /// SLP is selected and the user agreement set.
        7 slp_selected_and_agreed,
        /// SDI positive is selected.
        8 sdi_positive_selected,
        /// SDI negative is selected.
        9 sdi_negative_selected,
        /// The test stop is active.
        12 test_stop_active,
        /// The test stop is required.
        13 test_stop_required,
    }
}

word! {
    /// S_ZSW3B, r10234; with Extended Functions only (S120-SIC-505, S120-SIC-502).
    InfoWord3(u16) {
        /// The brake test is selected.
        0 brake_test_selected,
        /// The setpoint comes from the brake test, else from outside.
        1 internal_setpoint,
        /// Brake 2 is active, else brake 1.
        2 brake_2,
        /// The brake test is active.
        3 brake_test_active,
        /// The brake test was successful.
        4 brake_test_passed,
        /// The brake test is completed.
        5 brake_test_completed,
        /// The external brake is to close.
        6 close_external_brake,
        /// The load has a negative sign.
        7 negative_load,
        /// SS2E is active.
        11 ss2e_active,
        /// The acceptance test of SLP is selected.
        14 slp_acceptance_test,
        /// The acceptance test mode is selected.
        15 acceptance_mode,
    }
}

word! {
    /// S_STW1B, p10250 (S120-SIC-507).
    RequestWord1(u16) {
        /// The test stop of the Extended Functions is selected.
        8 test_stop,
    }
}

word! {
    /// S_STW3B, p10235 (S120-SIC-508).
    RequestWord3(u16) {
        /// The brake test is selected.
        0 select_brake_test,
        /// The brake test is started.
        1 start_brake_test,
        /// Brake 2, else brake 1.
        2 brake_2,
        /// Negative direction.
        3 negative_direction,
        /// Test sequence 2, else 1.
        4 sequence_2,
        /// The external brake is closed.
        5 external_brake_closed,
    }
}
