//! Fail-safe blocks for storage and retrieval machines: the step functions under test.

stillpoint_monitors::srm_monitors! { subject }
