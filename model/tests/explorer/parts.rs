//! Systems that fall into parts with common inputs: put together from the tables of their parts they give the report of
//! the plain exploration.

use crate::common::large::large_table;
use crate::common::{Frame, Table, padding, random_table};
use stillpoint_model::{
    Choices, Component, Domain, Fault, Form, Options, Property, Report, Storage, System, explore,
};

const ATOMS: usize = 6;

/// Some tables side by side. Input 0 is one and the same for all tables for which it has the same size.
struct Side {
    tables: Vec<Table>,
    domains: Vec<Domain>,
    apart: bool,
}

/// The inputs as one table sees them.
struct Renamed<'c, C> {
    choices: &'c mut C,
    table: u32,
    common: bool,
}

impl<C: Choices> Choices for Renamed<'_, C> {
    fn choose(&mut self, input: u32, size: u32) -> u32 {
        match input {
            0 if self.common => self.choices.choose(0, size),
            _ => self.choices.choose(10 * (self.table + 1) + input, size),
        }
    }
}

impl Side {
    fn new(tables: Vec<Table>, padded: usize, apart: bool) -> Self {
        let mut domains: Vec<Domain> = tables.iter().flat_map(|t| t.domains.clone()).collect();
        domains.extend(padding(padded));
        Side {
            tables,
            domains,
            apart,
        }
    }

    fn is_common(&self, table: usize) -> bool {
        self.tables[table].sizes[0] == self.tables[0].sizes[0]
    }

    fn choices<'c, C>(&self, table: usize, choices: &'c mut C) -> Renamed<'c, C> {
        Renamed {
            choices,
            table: table as u32,
            common: self.is_common(table),
        }
    }

    fn step<C: Choices>(
        &self,
        table: usize,
        work: &mut [Option<Frame>],
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        let (from, to) = (2 * table, 2 * table + 2);
        let mut frame = Frame::default();
        let mut choices = self.choices(table, choices);
        let state = &mut after[from..to];
        self.tables[table].next(&mut frame, &before[from..to], &mut choices, state)?;
        work[table] = Some(frame);
        Ok(())
    }
}

impl System for Side {
    type Work = Vec<Option<Frame>>;

    fn work(&self) -> Self::Work {
        vec![None; self.tables.len()]
    }

    fn domains(&self) -> &[Domain] {
        &self.domains
    }

    fn combinations(&self) -> u128 {
        let sizes = self.tables.iter().enumerate().map(|(n, t)| {
            let own = t.sizes[1..].iter().map(|s| u128::from(*s));
            let first = match n > 0 && self.is_common(n) {
                true => 1,
                false => u128::from(t.sizes[0]),
            };
            own.product::<u128>() * first
        });
        sizes.product()
    }

    fn initial<C: Choices>(&self, _: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        state.fill(77);
        for (n, table) in self.tables.iter().enumerate() {
            let mut choices = self.choices(n, choices);
            table.initial(
                &mut Frame::default(),
                &mut choices,
                &mut state[2 * n..2 * n + 2],
            );
        }
    }

    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        work.fill(None);
        after.copy_from_slice(before);
        (0..self.tables.len()).try_for_each(|n| self.step(n, work, before, choices, after))
    }

    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        let (table, atom) = (atom / ATOMS, atom % ATOMS);
        let Some(mut frame) = work[table] else {
            panic!("an atom of a part that made no step");
        };
        self.tables[table].atom(&mut frame, atom, &mut self.choices(table, choices))
    }

    fn rules(&self) -> usize {
        64 * self.tables.len()
    }

    fn fired(&self, work: &Self::Work, each: &mut impl FnMut(usize)) {
        for (n, table) in self.tables.iter().enumerate() {
            if let Some(frame) = &work[n] {
                table.fired(frame, &mut |rule| each(64 * n + rule));
            }
        }
    }

    fn components(&self) -> Vec<Component<'_>> {
        if !self.apart {
            return Vec::new();
        }
        let part = |n: usize| {
            let mut states = vec![2 * n, 2 * n + 1];
            if n == 0 {
                states.extend(2 * self.tables.len()..self.domains.len());
            }
            let atoms = (ATOMS * n..ATOMS * (n + 1)).collect();
            Component::new(states, atoms, Alone { whole: self, n })
        };
        (0..self.tables.len()).map(part).collect()
    }
}

/// One of the tables, as if the others were not there.
struct Alone<'a> {
    whole: &'a Side,
    n: usize,
}

impl System for Alone<'_> {
    type Work = Vec<Option<Frame>>;

    fn work(&self) -> Self::Work {
        self.whole.work()
    }

    fn domains(&self) -> &[Domain] {
        self.whole.domains()
    }

    fn combinations(&self) -> u128 {
        self.whole.combinations()
    }

    fn initial<C: Choices>(&self, work: &mut Self::Work, choices: &mut C, state: &mut [i32]) {
        self.whole.initial(work, choices, state);
    }

    fn next<C: Choices>(
        &self,
        work: &mut Self::Work,
        before: &[i32],
        choices: &mut C,
        after: &mut [i32],
    ) -> Result<(), Fault> {
        work.fill(None);
        after.copy_from_slice(before);
        self.whole.step(self.n, work, before, choices, after)
    }

    fn atom<C: Choices>(
        &self,
        work: &mut Self::Work,
        atom: usize,
        choices: &mut C,
    ) -> Result<bool, Fault> {
        self.whole.atom(work, atom, choices)
    }

    fn rules(&self) -> usize {
        self.whole.rules()
    }

    fn fired(&self, work: &Self::Work, each: &mut impl FnMut(usize)) {
        self.whole.fired(work, each);
    }
}

fn properties(tables: usize) -> Vec<Property> {
    let mut out = Vec::new();
    for table in 0..tables {
        let atom = |n: usize| ATOMS * table + n;
        let response = |within, fair| Form::LeadsTo {
            when: atom(0),
            goal: atom(1),
            within,
            fair,
            assuming: Some(atom(5)),
        };
        let forms = [
            Form::Always {
                when: Some(atom(0)),
                then: atom(5),
            },
            Form::Always {
                when: None,
                then: atom(4),
            },
            response(Some(3), vec![]),
            response(None, vec![atom(2)]),
            Form::Unless {
                when: atom(2),
                holds: atom(5),
                unless: atom(3),
            },
            Form::CanAlwaysReach {
                goal: atom(1),
                using: None,
            },
            Form::Reachable { goal: atom(3) },
        ];
        out.extend(forms.into_iter().enumerate().map(|(n, form)| Property {
            id: format!("{table}.{n}"),
            form,
        }));
    }
    out
}

fn report(side: &Side, properties: &[Property], threads: usize) -> Report {
    let mut options = Options::default();
    options.limits.threads = threads;
    let mut report = explore(side, properties, &options, &mut ()).unwrap();
    report.seconds = 0.0;
    report.memory = 0;
    report.stored = 0;
    report
}

#[test]
fn tables_of_parts_give_the_plain_report() {
    let (mut faulty, mut several) = (0, 0);
    for seed in 0..120u64 {
        let number = 2 + (seed % 2) as usize;
        let table = |n: usize| {
            let seed = 7 * seed + n as u64;
            match n + seed as usize % 3 {
                0 => large_table(seed, ATOMS),
                _ => random_table(seed, ATOMS, padding(0)),
            }
        };
        let tables: Vec<Table> = (0..number).map(table).collect();
        // A bitmap, and hash sets for keys of one half and of two.
        let padded = [0, 0, 1, 3][(seed % 4) as usize];
        let properties = properties(number);
        let plain = report(&Side::new(tables.clone(), padded, false), &properties, 1);
        let threads = 1 + (seed % 3) as usize;
        let joined = report(&Side::new(tables, padded, true), &properties, threads);
        assert_eq!(joined, plain, "seed {seed}");
        faulty += usize::from(!plain.faults.is_empty());
        several += usize::from(plain.states > 100 && plain.faults.is_empty());
    }
    assert!(faulty > 5 && several > 10, "{faulty} {several}");
}

#[test]
fn a_property_about_two_parts_is_judged_all_the_same() {
    let tables: Vec<Table> = (0..2)
        .map(|n| random_table(40 + n, ATOMS, padding(0)))
        .collect();
    let both = [Property {
        id: "both".to_owned(),
        form: Form::Always {
            when: Some(0),
            then: ATOMS,
        },
    }];
    let plain = report(&Side::new(tables.clone(), 0, false), &both, 1);
    assert_eq!(report(&Side::new(tables, 0, true), &both, 1), plain);
}

#[test]
fn intervals_of_a_timer_change_neither_verdicts_nor_lengths() {
    let mut violated = 0;
    for seed in 0..300u64 {
        let mut table = match seed % 2 {
            0 => large_table(seed, ATOMS),
            _ => random_table(seed, ATOMS, padding(0)),
        };
        // Any variable may be the one that is stored in intervals.
        table.timer = Some((seed / 2 % 2) as usize);
        let run = |intervals| {
            let options = Options {
                intervals,
                ..Options::default()
            };
            let mut report = explore(&table, &properties(1), &options, &mut ()).unwrap();
            let storage = report.storage;
            report.storage = Storage::Bitmap;
            (report.seconds, report.memory, report.stored) = (0.0, 0, 0);
            report.absorbing_examples.sort();
            // Of several shortest runs another one may be the first in the order of indices; one that ends in a loop
            // need not be the shortest.
            for judgement in &mut report.properties {
                let trace = judgement.trace.take();
                if trace.is_some_and(|t| t.loop_start.is_some()) {
                    judgement.length = None;
                }
            }
            for trace in report.faults.iter_mut().map(|f| &mut f.trace) {
                *trace = None;
            }
            (report, storage)
        };
        let (plain, bitmap) = run(false);
        let (other, intervals) = run(true);
        assert_eq!((bitmap, intervals), (Storage::Bitmap, Storage::Intervals));
        if plain.absorbing <= 8 {
            assert_eq!(other, plain, "seed {seed}");
        }
        violated += usize::from(plain.properties[2].length.is_some());
    }
    assert!(violated > 30, "{violated}");
}
