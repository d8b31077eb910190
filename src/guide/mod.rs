//! Guide. Chapters are documentation only; their programs are tests.
//!
//! | chapter | for whom |
//! |---|---|
//! | [`lockstep`] | a lockstep game in 20 minutes: inputs to commands, rollback, peers, spectators, late joiners |
//! | [`determinism`] | what is promised, what the game must do, what is checked where |
//! | [`replays`] | recording, verifying, and finding out why two machines differ |
//! | [`impacts`] | what happens when things meet, and what is promised of it |
//! | [`sleeping`] | what rests need not be computed |

pub mod determinism;
pub mod impacts;
pub mod lockstep;
pub mod replays;
pub mod sleeping;
