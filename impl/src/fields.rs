//! The types of the monitors as numbers with names, for code that knows no monitor: the comparison with the tables, the
//! drawing of arbitrary steps for the proofs, the pages.
//!
//! `fields!` declares a type of a monitor and makes it known. What a number means is the business of its type: a
//! choice is the number of the variant (its place, unless the declaration gives another one), a duration its cycles, a
//! position its increments.

use crate::kernel::{Cycles, Distance, Percent, Position, Speed};

/// What values a number can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 0 and 1.
    Truth,
    /// The numbers of these variants, ascending.
    Choice(&'static [(&'static str, i64)]),
    /// Whole numbers, both ends included.
    Whole(i64, i64),
}

impl Kind {
    /// The least and the greatest value.
    pub const fn ends(self) -> (i64, i64) {
        match self {
            Self::Truth => (0, 1),
            Self::Choice([(_, low), .., (_, high)]) => (*low, *high),
            Self::Choice(_) => (0, 0),
            Self::Whole(low, high) => (low, high),
        }
    }
}

/// What goes over the numbers of a value.
pub trait Visitor {
    /// A number of this name; what is returned takes its place. A number outside its kind is replaced by the nearest
    /// one of the kind.
    fn number(&mut self, name: &'static str, kind: Kind, value: i64) -> i64;

    /// The numbers up to the matching [`Visitor::close`] are parts of the field of this name.
    fn open(&mut self, _name: &'static str) {}

    /// Ends the field that was opened last.
    fn close(&mut self) {}

    /// The numbers up to the matching [`Visitor::present`] belong to a value that is missing: what is returned for them is
    /// dropped. They are shown all the same, so that a type has the same numbers in the same order whatever its value.
    fn absent(&mut self) {}

    /// Ends what [`Visitor::absent`] began.
    fn present(&mut self) {}
}

/// A value made of numbers with names.
pub trait Fields: Copy + Send + Sync + 'static {
    /// Some value, to begin with.
    const ANY: Self;

    /// Shows each number to the visitor, in the order of the declaration, and takes what it returns: the same numbers for every
    /// value. The result need not satisfy any invariant. `name` is that of the field with this value; a value on its own has none.
    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V);
}

/// Hands on each number.
struct Get<F>(F);

impl<F: FnMut(i64)> Visitor for Get<F> {
    fn number(&mut self, _: &'static str, _: Kind, value: i64) -> i64 {
        (self.0)(value);
        value
    }
}

/// Hands on the numbers of a value.
pub fn get<T: Fields>(mut value: T, each: impl FnMut(i64)) {
    value.visit("", &mut Get(each));
}

/// Sets each number to the next one.
struct Set<I>(I);

impl<I: Iterator<Item = i64>> Visitor for Set<I> {
    fn number(&mut self, _: &'static str, _: Kind, value: i64) -> i64 {
        self.0.next().unwrap_or(value)
    }
}

/// The value with these numbers. One that the type does not have becomes the nearest; what is missing is that of
/// [`Fields::ANY`].
pub fn set<T: Fields>(numbers: impl Iterator<Item = i64>) -> T {
    let mut value = T::ANY;
    value.visit("", &mut Set(numbers));
    value
}

/// No number is in more fields than this, itself counted.
const DEPTH: usize = 8;

/// Hands on the names of the numbers.
struct Walk<F> {
    path: [&'static str; DEPTH],
    depth: usize,
    each: F,
}

impl<F: FnMut(&[&'static str], Kind)> Visitor for Walk<F> {
    fn number(&mut self, name: &'static str, kind: Kind, value: i64) -> i64 {
        self.open(name);
        (self.each)(self.path.get(..self.depth).unwrap_or(&self.path), kind);
        self.close();
        value
    }

    fn open(&mut self, name: &'static str) {
        debug_assert!(
            self.depth < DEPTH,
            "a number is in more fields than have room"
        );
        if let Some(place) = self.path.get_mut(self.depth) {
            *place = name;
        }
        self.depth += 1;
    }

    fn close(&mut self) {
        self.depth = self.depth.saturating_sub(1);
    }
}

/// Hands on the name of each number of a type with the names of the fields it is in, `part` first, and its kind.
pub fn walk<T: Fields>(part: &'static str, each: impl FnMut(&[&'static str], Kind)) {
    let mut walk = Walk {
        path: [""; DEPTH],
        depth: 0,
        each,
    };
    let mut value = T::ANY;
    value.visit(part, &mut walk);
}

/// Shows a number and gives back one of the kind.
fn whole<V: Visitor + ?Sized>(
    visitor: &mut V,
    name: &'static str,
    (low, high): (i64, i64),
    value: i64,
) -> i64 {
    nearest(
        visitor.number(name, Kind::Whole(low, high), value),
        low,
        high,
    )
}

/// The nearest number of a range. Kani draws no other one, and a comparison of each number with both ends would be in its formula.
pub(crate) fn nearest(number: i64, low: i64, high: i64) -> i64 {
    if cfg!(kani) {
        number
    } else {
        number.clamp(low, high)
    }
}

macro_rules! integers {
    ($($type:ident)+) => {$(
        impl Fields for $type {
            const ANY: Self = 0;

            fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
                *self = whole(visitor, name, (Self::MIN as i64, Self::MAX as i64), *self as i64) as Self;
            }
        }
    )+};
}

integers! { u8 u16 u32 i8 i16 i32 i64 }

impl Fields for bool {
    const ANY: Self = false;

    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
        *self = visitor.number(name, Kind::Truth, i64::from(*self)) != 0;
    }
}

macro_rules! measures {
    ($($type:ident)+) => {$(
        impl Fields for $type {
            const ANY: Self = Self(0);

            fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
                self.0.visit(name, visitor);
            }
        }
    )+};
}

measures! { Position Distance Speed }

impl Fields for Cycles {
    const ANY: Self = Self::ZERO;

    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
        let mut count = self.count();
        count.visit(name, visitor);
        *self = Self::new(count);
    }
}

impl Fields for Percent {
    const ANY: Self = Self::WHOLE;

    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
        let percent = whole(visitor, name, (0, 100), i64::from(self.get()));
        *self = Self::new(percent as u8).unwrap_or(Self::WHOLE);
    }
}

/// A value that may be missing: whether it is there (`some`), and its numbers (`value`).
impl<T: Fields> Fields for Option<T> {
    const ANY: Self = None;

    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
        visitor.open(name);
        let mut some = self.is_some();
        some.visit("some", visitor);
        let mut value = self.unwrap_or(T::ANY);
        if !some {
            visitor.absent();
        }
        value.visit("value", visitor);
        if !some {
            visitor.present();
        }
        *self = some.then_some(value);
        visitor.close();
    }
}

/// The names of the elements of a list.
const PLACES: [&str; 16] = [
    "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15",
];

impl<T: Fields, const N: usize> Fields for [T; N] {
    const ANY: Self = [T::ANY; N];

    fn visit<V: Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
        const { assert!(N <= PLACES.len()) };
        visitor.open(name);
        // By places: a model checker takes a hundred steps for each element of two lists that are zipped.
        let mut place = 0;
        while place < N {
            // `place` is below both lengths.
            #[allow(clippy::indexing_slicing)]
            self[place].visit(PLACES[place], visitor);
            place += 1;
        }
        visitor.close();
    }
}

/// Declares a type of a monitor and makes its fields known: a structure, a number with a range of its own, or a choice whose variants carry nothing (which gets
/// the list `ALL` of its variants).
macro_rules! fields {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {$(
        $(#[$about:meta])* $part:vis $field:ident: $type:ty,
    )+}) => {
        $(#[$meta])*
        $vis struct $name {$(
            $(#[$about])* $part $field: $type,
        )+}

        impl $crate::fields::Fields for $name {
            const ANY: Self = Self { $($field: <$type as $crate::fields::Fields>::ANY,)+ };

            fn visit<V: $crate::fields::Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
                visitor.open(name);
                $($crate::fields::Fields::visit(&mut self.$field, stringify!($field), visitor);)+
                visitor.close();
            }
        }
    };
    ($(#[$meta:meta])* $vis:vis struct $name:ident($number:ty) in $low:literal..=$high:literal;) => {
        $(#[$meta])*
        $vis struct $name($number);

        impl $crate::fields::Fields for $name {
            const ANY: Self = Self($low);

            fn visit<V: $crate::fields::Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
                let kind = $crate::fields::Kind::Whole($low, $high);
                let number = visitor.number(name, kind, self.0 as i64);
                *self = Self($crate::fields::nearest(number, $low, $high) as $number);
            }
        }
    };
    ($(#[$meta:meta])* $vis:vis struct $name:ident;) => {
        $(#[$meta])*
        $vis struct $name;

        impl $crate::fields::Fields for $name {
            const ANY: Self = Self;

            fn visit<V: $crate::fields::Visitor + ?Sized>(&mut self, _: &'static str, _: &mut V) {}
        }
    };
    ($(#[$meta:meta])* $vis:vis enum $name:ident {$(
        $(#[$about:meta])* $variant:ident $(= $number:literal)?,
    )+}) => {
        $(#[$meta])*
        $vis enum $name {$(
            $(#[$about])* $variant $(= $number)?,
        )+}

        impl $name {
            /// Every one, in the order of the declaration.
            pub const ALL: [Self; [$(stringify!($variant)),+].len()] = [$(Self::$variant),+];
        }

        impl $crate::fields::Fields for $name {
            const ANY: Self = Self::ALL[0];

            fn visit<V: $crate::fields::Visitor + ?Sized>(&mut self, name: &'static str, visitor: &mut V) {
                let kind = $crate::fields::Kind::Choice(&[$((stringify!($variant), Self::$variant as i64)),+]);
                let number = visitor.number(name, kind, *self as i64);
                // Of a number between two variants the higher one, of one beyond all the last.
                *self = 'nearest: {
                    $(if number <= Self::$variant as i64 {
                        break 'nearest Self::$variant;
                    })+
                    Self::ALL[Self::ALL.len() - 1]
                };
            }
        }
    };
}

/// Declares the configuration of a monitor like `fields!`, and which values are one: those that the constructor `new`
/// gives when it is handed the fields in their order, or those for which the expression at the end holds.
macro_rules! config {
    ($(#[$meta:meta])* pub struct Config { $($(#[$about:meta])* $part:vis $field:ident: $type:ty,)+ }) => {
        config! {
            $(#[$meta])* pub struct Config { $($(#[$about])* $part $field: $type,)+ }
            accepted |config| Config::new($(config.$field),+).is_ok_and(|made| made == *config)
        }
    };
    ($(#[$meta:meta])* pub struct Config { $($(#[$about:meta])* $part:vis $field:ident: $type:ty,)+ }
        accepted |$config:ident| $accepted:expr) => {
        fields! { $(#[$meta])* pub struct Config { $($(#[$about])* $part $field: $type,)+ } }

        impl Config {
            /// Whether a constructor gives this configuration.
            pub fn accepted(&self) -> bool {
                let $config = self;
                $accepted
            }
        }
    };
    ($(#[$meta:meta])* pub struct Config;) => {
        fields! { $(#[$meta])* pub struct Config; }

        impl Config {
            /// There is one only.
            pub fn accepted(&self) -> bool {
                true
            }
        }
    };
}
