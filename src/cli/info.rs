//! `tamias2d info`

use super::table::rounded;
use super::{Failure, verify};
use std::io::Write;
use std::path::PathBuf;
use tamias2d::BodyKind;

/// Say what is in a replay, without playing it.
///
/// The file is read to its end, so its checks and its digest are checked too; the hashes of the ticks are not (that
/// is what `verify` does).
#[derive(clap::Args)]
pub(crate) struct Info {
    /// A replay file
    file: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Info {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let player = verify::open(&self.file)?;
        let world = player.world().clone();
        let config = world.config();
        let kinds = [BodyKind::Dynamic, BodyKind::Kinematic, BodyKind::Static]
            .map(|kind| world.bodies().filter(|body| body.kind() == kind).count());
        let [dynamic, kinematic, fixed] = kinds;
        let (attractors, colliders) = (world.attractors().count(), world.colliders().count());
        let (version, law) = (tamias2d::replay::REPLAY_VERSION, tamias2d::LAW);
        let (rate, substeps) = (config.tick_rate, config.substeps);
        let start = world.hash();
        let contents = player.inspect().map_err(|error| verify::failure(&self.file, &error))?;
        let (ticks, commands, end) = (contents.summary.ticks, contents.summary.commands, contents.summary.hash);
        let (keyframes, evidence) = (contents.keyframes.len(), contents.evidence);
        let milliseconds = u128::from(ticks) * 1000 / u128::from(rate);
        let mut out = std::io::stdout().lock();
        if self.json {
            writeln!(
                out,
                "{{\"format\":{version},\"law\":{law},\"tick_rate\":{rate},\"substeps\":{substeps},\"dynamic\":{dynamic},\
                 \"kinematic\":{kinematic},\"static\":{fixed},\"colliders\":{colliders},\"attractors\":{attractors},\
                 \"ticks\":{ticks},\"commands\":{commands},\"keyframes\":{keyframes},\"evidence\":{evidence},\"first_hash\":\"{start:016x}\",\"last_hash\":\"{end:016x}\"}}"
            )?;
            return Ok(());
        }
        writeln!(out, "replay      format {version}, arithmetic law {law}")?;
        writeln!(out, "time        {ticks} ticks of 1/{rate} s, {}.{:03} s", milliseconds / 1000, milliseconds % 1000)?;
        writeln!(out, "motion      {:?}, {substeps} substeps", config.integrator)?;
        writeln!(out, "gravity     ({}, {}) m/s²", rounded(config.gravity.x, 6), rounded(config.gravity.y, 6))?;
        writeln!(
            out,
            "at start    {dynamic} dynamic, {kinematic} kinematic, {fixed} static bodies, {colliders} colliders, \
             {attractors} attractors"
        )?;
        writeln!(out, "commands    {commands}")?;
        writeln!(out, "keyframes   {keyframes}, and {evidence} ticks with evidence")?;
        writeln!(out, "hashes      {start:016x} at tick 0, {end:016x} at the end")?;
        Ok(())
    }
}
