//! Settings at random.

use proptest::prelude::*;
use proptest::sample::{select, subsequence};

use crate::settings::{Declaration, Description, Kind, Range, Settings, Value, options};

/// Settings with a random value for every option.
pub fn settings() -> impl Strategy<Value = Settings> {
    let values: Vec<_> = options::all().map(value).collect();
    values.prop_map(|values| {
        let mut settings = Settings::opening();
        // Two overlays that colour the surface clash; such a value is refused and changes nothing.
        options::all().zip(values).for_each(|(option, value)| _ = option.set(&mut settings, value));
        settings
    })
}

/// Any value of an option.
fn value(option: &'static Declaration) -> BoxedStrategy<Value> {
    let names = |all: Vec<Description>| all.iter().map(|value| value.name).collect::<Vec<_>>();
    let number = |&Range { least, most, .. }: &Range| least..=most;
    let any = match &option.kind {
        Kind::Choice(all) => select(names(all())).prop_map(Value::Name).boxed(),
        Kind::Several(all) => subsequence(names(all()), 0..6).prop_map(Value::Names).boxed(),
        Kind::Number(range) => number(range).prop_map(Value::Number).boxed(),
        Kind::NameOrNumber { names: all, range, .. } => {
            prop_oneof![select(names(all())).prop_map(Value::Name), number(range).prop_map(Value::Number)].boxed()
        }
        Kind::Pair(range) => {
            [number(range), number(range)].prop_map(|[a, b]| Value::Pair([a.min(b), a.max(b)])).boxed()
        }
        Kind::Switch => any::<bool>().prop_map(Value::Switch).boxed(),
        Kind::Color => any::<[u8; 3]>().prop_map(Value::Color).boxed(),
        Kind::Options(all) => {
            let all = *all;
            let places: Vec<usize> = (0..all().len()).collect();
            let value = move |place: usize| value(all()[place]).prop_map(move |value| (all()[place].name, value));
            let values = move |places: Vec<usize>| places.into_iter().map(value).collect::<Vec<_>>();
            subsequence(places, 0..4).prop_flat_map(values).prop_map(Value::Options).boxed()
        }
    };
    if option.unset.is_none() { any } else { prop_oneof![Just(Value::Unset), any].boxed() }
}
