//! All reachable states in order.

use crate::cursor::Leaf;
use crate::explore::{Job, crew, on_store};
use crate::level::UNWATCHED;
use crate::model::Model;
use crate::process::{Any, Origin};
use crate::report::{Error, Options, Storage};
use crate::search::initial;
use crate::store::Store;
use crate::system::System;
use crate::watch::Watch;
use std::ops::ControlFlow;

/// Calls `each` with every reachable state, by depth and in the order of indices inside a depth. The answer says
/// whether all reachable states were met.
///
/// # Errors
/// As [`crate::explore`].
pub fn reachable<S: System>(
    system: &S,
    options: &Options,
    each: &mut dyn FnMut(&[i32]),
) -> Result<bool, Error> {
    visit(Any::new(system), options, each)
}

/// The same for any system, so that it is compiled once.
#[inline(never)]
fn visit(system: Any, options: &Options, each: &mut dyn FnMut(&[i32])) -> Result<bool, Error> {
    let watch = Watch::new(options);
    on_store(system, options, &crew(options)?, &watch, Visit { each })
}

struct Visit<'a> {
    each: &'a mut dyn FnMut(&[i32]),
}

impl Job<Any<'_>> for Visit<'_> {
    type Output = bool;

    fn run<T: Store>(
        self,
        model: &Model<Any, T::Key>,
        mut store: T,
        _: Storage,
    ) -> Result<bool, Error> {
        let mut state = vec![0; model.origin.domains().len()];
        let mut workers: Vec<_> = (0..model.crew.size())
            .map(|_| (model.cursor(), store.local()))
            .collect();
        let (mut frontier, _) = initial(model, &mut store, model.cursor(), model.watch)?;
        while frontier > 0 && !model.watch.over(store.bytes()) {
            for key in store.frontier() {
                model.packer.unpack(key, &mut state);
                (self.each)(&state);
            }
            let now = &store;
            model
                .crew
                .share(&mut workers, now.pieces(), |(cursor, local), piece| {
                    if model.watch.over(now.bytes()) {
                        return;
                    }
                    let mut unwatched = 0;
                    now.each(piece, |key| {
                        cursor.leaves(&model.packer, key, |_, _, leaf| {
                            if let Leaf::To(after) = leaf {
                                now.visit(local, after);
                            }
                            unwatched += 1;
                            if unwatched % UNWATCHED == 0 && model.watch.over(now.bytes()) {
                                return ControlFlow::Break(());
                            }
                            ControlFlow::Continue(())
                        });
                    });
                });
            frontier = store.advance(workers.iter_mut().map(|(_, local)| local).collect());
        }
        Ok(!model.watch.stopped())
    }
}
