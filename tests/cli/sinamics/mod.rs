//! `stillpoint acceptance` for machines with SINAMICS S120.

mod acceptance;
