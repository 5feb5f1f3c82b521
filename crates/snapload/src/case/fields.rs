//! How the list of a case's keys becomes a struct of their values and a schema.

/// What a field of each type is: its value in another arithmetic, its default as it is shown, and
/// how it is read and stored. An `Option<T>` is a number that a case may be without.
macro_rules! field {
    (map [T] $p:ident.$name:ident $number:ident) => {
        $number(stringify!($name), $p.$name)
    };
    (map [Option<T>] $p:ident.$name:ident $number:ident) => {
        $p.$name.map(|value| $number(stringify!($name), value))
    };
    (map $type:tt $p:ident.$name:ident $number:ident) => {
        $p.$name
    };

    (default [T] $name:ident) => {
        DefaultValue::Number(Parameters::STANDARD.$name)
    };
    (default [Option<T>] $name:ident) => {
        DefaultValue::Derived("none")
    };
    (default [bool] $name:ident) => {
        DefaultValue::Flag(Parameters::STANDARD.$name)
    };
    (default [u64] $name:ident) => {
        DefaultValue::Count(Parameters::STANDARD.$name as i64)
    };

    (get [T] $name:ident) => {
        Get::Number(|p| Some(p.$name))
    };
    (get [Option<T>] $name:ident) => {
        Get::Number(|p| p.$name)
    };
    (get [bool] $name:ident) => {
        Get::Flag(|p| p.$name)
    };
    (get [u64] $name:ident) => {
        Get::Count(|p| p.$name)
    };

    (store [T] $name:ident) => {
        Store::Number(|p, value| p.$name = value)
    };
    (store [Option<T>] $name:ident) => {
        Store::Number(|p, value| p.$name = Some(value))
    };
    (store [bool] $name:ident) => {
        Store::Flag(|p, value| p.$name = value)
    };
    (store [u64] $name:ident) => {
        Store::Count(|p, value| p.$name = value)
    };
}
pub(crate) use field;

/// Everything that follows from the list of keys: `Parameters` with `map` and `STANDARD`, `KEYS`
/// and `FIELDS`. A row is
///
/// `group name: type = standard value, unit, allowed values, meaning, details`
///
/// where the details are further properties of the [`Key`](crate::case::key::Key).
macro_rules! case_keys {
    (
        $(#[$of_struct:meta])*
        struct Parameters;
        $(
            $(#[$of_field:meta])*
            $group:literal $name:ident: $type:ident $(<$of:ident>)? = $standard:expr,
            $unit:literal, $allowed:expr, $meaning:literal $(.$detail:ident($($argument:expr),*))*;
        )*
        without a field: $key:expr, $get:expr;
    ) => {
        $(#[$of_struct])*
        pub struct Parameters<T = f64> {
            $(
                #[doc = $meaning]
                $(#[$of_field])*
                pub $name: $type $(<$of>)?,
            )*
        }

        impl<T: Copy> Parameters<T> {
            /// The same case with its numbers in another arithmetic; `number` converts each number
            /// and receives its key.
            pub fn map<U>(&self, mut number: impl FnMut(&'static str, T) -> U) -> Parameters<U> {
                let p = self;
                Parameters { $($name: field!(map [$type $(<$of>)?] p.$name number),)* }
            }
        }

        impl Parameters {
            /// The standard case of the chapter (1910001000-359), which also holds the defaults.
            pub const STANDARD: Self = Self { $($name: $standard,)* };
        }

        /// Every key of a case, in the order in which they are listed.
        pub const KEYS: &[Key] = &[
            $(
                Key::new(
                    stringify!($name), $unit, $allowed,
                    field!(default [$type $(<$of>)?] $name), $meaning,
                )
                .in_group($group)
                $(.$detail($($argument),*))*,
            )*
            $key,
        ];

        /// The accessors of each key, in the same order.
        pub(crate) const FIELDS: &[(Get, Store)] = &[
            $((field!(get [$type $(<$of>)?] $name), field!(store [$type $(<$of>)?] $name)),)*
            ($get, Store::None),
        ];
    };
}
pub(crate) use case_keys;
