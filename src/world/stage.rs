//! The stages of a tick, by name.

use core::fmt;

macro_rules! stages {
    ($($(#[$doc:meta])* $number:literal => $name:ident, $text:literal;)*) => {
        /// A stage of [`World::step`](crate::World::step), in the order of a tick. A tick that touches what sleeps goes from
        /// [`Stage::Wake`] back to [`Stage::Find`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Stage {
            $($(#[$doc])* $name,)*
        }

        impl Stage {
            /// All of them, in order.
            pub const ALL: &'static [Stage] = &[$(Stage::$name),*];

            /// The number by which evidence names it.
            pub fn number(self) -> u8 {
                match self {
                    $( Stage::$name => $number, )*
                }
            }

            /// The stage of a number.
            pub fn of(number: u8) -> Option<Stage> {
                match number {
                    $( $number => Some(Stage::$name), )*
                    _ => None,
                }
            }
        }

        impl fmt::Display for Stage {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self {
                    $( Stage::$name => $text, )*
                })
            }
        }
    };
}

stages! {
    /// The tick's commands have been carried out, and nothing else of it.
    0 => Begin, "begin";
    /// Forces of one tick are part of the prepared motion.
    1 => Forces, "forces";
    /// Contacts are sorted into those of what is awake and of what sleeps.
    2 => Sort, "sort";
    /// The pairs of this tick and their manifolds are found.
    3 => Find, "find";
    /// Rows are written.
    4 => Prepare, "prepare";
    /// Bodies have moved as if nothing touched them.
    5 => Integrate, "integrate";
    /// Rows and impacts have had their say; contacts have put bodies where they belong.
    6 => Solve, "solve";
    /// What sleeps was touched and is awake; the tick is taken back, and begins again with [`Stage::Find`].
    7 => Wake, "wake";
    /// The contacts that last are those of the next tick; events are known.
    8 => Contacts, "contacts";
    /// Forces of this tick are no longer part of the prepared motion.
    9 => Release, "release";
    /// Quiet islands are asleep.
    10 => Sleep, "sleep";
    /// The status names what went out of range, and the tick is counted.
    11 => Close, "close";
}
