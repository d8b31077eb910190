//! What is asked of a session of ggrs. The three kinds answer alike.

use super::Game;
use core::marker::PhantomData;
use ggrs::{Config, Frame, GgrsError, GgrsRequest, P2PSession, SpectatorSession, SyncTestSession};

/// The types of a session for a game: for ggrs's `SessionBuilder`.
///
/// Missing inputs are predicted by `P`, the last one again if nobody says otherwise; peers are known by `A`, their
/// address.
pub struct Net<G, P = ggrs::PredictRepeatLast, A = std::net::SocketAddr>(PhantomData<(G, P, A)>);

impl<G, P, A> Config for Net<G, P, A>
where
    G: Game + 'static,
    P: ggrs::InputPredictor<G::Input> + 'static,
    A: Clone + PartialEq + Eq + core::hash::Hash + core::fmt::Debug + 'static,
{
    type Input = G::Input;
    type InputPredictor = P;
    /// States are kept by [`Lockstep`](super::Lockstep).
    type State = ();
    type Address = A;
}

/// A session of ggrs, of any kind.
pub trait Session<I> {
    /// Its types.
    type Config: Config<Input = I, State = ()>;

    /// Advances by a frame: what is to be done for it.
    fn advance(&mut self) -> Result<Vec<GgrsRequest<Self::Config>>, GgrsError>;

    /// By how many frames it may go back.
    fn window(&self) -> usize;

    /// The frame up to which all inputs are known, right after advancing. Later polls may know of more, of which the states
    /// are not corrected yet.
    fn confirmed(&self) -> Frame;
}

impl<C: Config<State = ()>> Session<C::Input> for P2PSession<C> {
    type Config = C;

    fn advance(&mut self) -> Result<Vec<GgrsRequest<C>>, GgrsError> {
        self.advance_frame()
    }

    fn window(&self) -> usize {
        self.max_prediction()
    }

    fn confirmed(&self) -> Frame {
        self.confirmed_frame()
    }
}

impl<C: Config<State = ()>> Session<C::Input> for SpectatorSession<C> {
    type Config = C;

    fn advance(&mut self) -> Result<Vec<GgrsRequest<C>>, GgrsError> {
        self.advance_frame()
    }

    fn window(&self) -> usize {
        0
    }

    fn confirmed(&self) -> Frame {
        self.current_frame()
    }
}

impl<C: Config<State = ()>> Session<C::Input> for SyncTestSession<C> {
    type Config = C;

    fn advance(&mut self) -> Result<Vec<GgrsRequest<C>>, GgrsError> {
        self.advance_frame()
    }

    fn window(&self) -> usize {
        self.max_prediction()
    }

    fn confirmed(&self) -> Frame {
        self.current_frame().saturating_sub_unsigned(self.check_distance().saturating_add(1) as u32)
    }
}
