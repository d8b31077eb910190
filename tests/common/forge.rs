//! Replays that no recorder writes.
#![allow(dead_code, reason = "each test uses some of it")]

use tamias2d::replay::REPLAY_VERSION;
use tamias2d::{LAW, World};
use twox_hash::XxHash3_64;

/// A replay written by hand, from the description of the format alone.
pub struct Forge {
    pub bytes: Vec<u8>,
    pub chain: u64,
}

impl Forge {
    pub fn new(tick_rate: u32) -> Forge {
        Forge::of(REPLAY_VERSION, LAW, tick_rate, 0)
    }

    pub fn of(version: u32, law: u32, tick_rate: u32, zero: u32) -> Forge {
        let mut bytes = b"TAMIAS-R".to_vec();
        for value in [version, law, tick_rate, zero] {
            bytes.extend(value.to_le_bytes());
        }
        let chain = XxHash3_64::oneshot(&bytes);
        bytes.extend(chain.to_le_bytes());
        Forge { bytes, chain }
    }

    pub fn chained(mut self, record: &[u8]) -> Forge {
        self.chain = XxHash3_64::oneshot_with_seed(self.chain, record);
        self.bytes.extend(record);
        self.bytes.extend((self.chain as u32).to_le_bytes());
        self
    }

    pub fn record(self, tag: u8, payload: &[u8]) -> Forge {
        let mut record = vec![tag];
        record.extend((payload.len() as u32).to_le_bytes());
        record.extend(payload);
        self.chained(&record)
    }

    pub fn world(self, world: &World) -> Forge {
        self.record(0x01, &world.save())
    }

    pub fn idle(self, hash: u64) -> Forge {
        let mut forge = self;
        let mut record = vec![0x02];
        record.extend(hash.to_le_bytes());
        forge.chain = XxHash3_64::oneshot_with_seed(forge.chain, &record);
        forge.bytes.extend(record);
        forge
    }

    /// A tick (0x03) or a tail (0x04) with encoded commands.
    pub fn with_commands(self, tag: u8, hash: u64, commands: &[u8]) -> Forge {
        let mut payload = hash.to_le_bytes().to_vec();
        payload.extend(commands);
        self.record(tag, &payload)
    }

    pub fn end(mut self, ticks: u64) -> Vec<u8> {
        let mut record = vec![0x0f];
        record.extend(ticks.to_le_bytes());
        record.extend(0u64.to_le_bytes());
        let chain = XxHash3_64::oneshot_with_seed(self.chain, &record);
        self.bytes.extend(record);
        self.bytes.extend(chain.to_le_bytes());
        self.bytes
    }
}
