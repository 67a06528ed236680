//! Functions of IEC 61800-5-2: the step functions under test.

stillpoint_monitors::iec_monitors! { subject }
