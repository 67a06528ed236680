//! Stillpoint proves that a machine stops: model checker and differential checker of drive safety functions.
