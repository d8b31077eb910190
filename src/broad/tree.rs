//! A tree of boxes without links: blocks of eight, packed level upon level.

use super::rect::Rect;
use crate::store::clone_fields;

/// How many boxes a box of the next level is around.
const BLOCK: usize = 8;
type Block = [Rect; BLOCK];
/// No proxy, no leaf.
const NONE: u32 = u32::MAX;
/// Tests that a query in a good tree makes, per level and per box found.
const FAIR_TESTS: usize = 8;
/// Needless tests per leaf that cost as much as building the tree.
const TESTS_PER_BUILD: usize = 40;

/// Boxes by proxy. What it answers does not depend on its shape; how fast it answers does, so it counts needless
/// tests and is built anew when those have cost as much as building does.
#[derive(Debug, Default)]
pub(super) struct Tree {
    /// The leaves, and above them levels: a box for each block of the level before. The last level is one block.
    levels: Vec<Vec<Block>>,
    /// Whose box a leaf is; [`NONE`] once that is removed.
    proxies: Vec<u32>,
    /// Where a proxy's leaf is.
    leaves: Vec<u32>,
    live: usize,
    /// Leaves added since the last update.
    added: usize,
    /// Boxes set or removed since the levels were last drawn tight.
    loose: usize,
    /// Needless tests since the tree was built.
    waste: usize,
    /// Space for building.
    items: Vec<Item>,
    blocks: Vec<Block>,
    names: Vec<u32>,
    /// Levels that a tree of fewer leaves does not need.
    spare: Vec<Vec<Block>>,
}

clone_fields!(Tree { levels, proxies, leaves, live, added, loose, waste, items, blocks, names, spare });

/// A leaf while the tree is built.
#[derive(Clone, Copy, Debug)]
struct Item {
    middle: [i64; 2],
    leaf: u32,
}

impl Tree {
    pub(super) fn is_empty(&self) -> bool {
        self.live == 0
    }

    /// Sets a proxy's box. Boxes above only grow, until [`Tree::tighten`].
    pub(super) fn set(&mut self, proxy: u32, rect: &Rect) {
        let slot = proxy as usize;
        if self.leaves.len() <= slot {
            self.leaves.resize(slot.saturating_add(1), NONE);
        }
        if self.leaves[slot] == NONE {
            self.leaves[slot] = self.proxies.len() as u32;
            self.proxies.push(proxy);
            self.live = self.live.saturating_add(1);
            self.added = self.added.saturating_add(1);
        }
        self.loose = self.loose.saturating_add(1);
        let (mut at, mut rect) = (self.leaves[slot] as usize, *rect);
        for level in 0..=self.levels.len() {
            let (block, column) = (at / BLOCK, at % BLOCK);
            if level == self.levels.len() {
                self.levels.push(self.spare.pop().unwrap_or_default());
                self.levels[level].clear();
                if level > 0 {
                    // Of the level below, this is the second block: the first had no box so far.
                    let first = union(&self.levels[level.wrapping_sub(1)][0]);
                    self.levels[level].push([Rect::NOTHING; BLOCK]);
                    self.levels[level][0][0] = first;
                }
            }
            let blocks = &mut self.levels[level];
            if block == blocks.len() {
                blocks.push([Rect::NOTHING; BLOCK]);
            }
            let around = &mut blocks[block][column];
            if level == 0 {
                *around = rect;
            } else if around.contains(&rect) {
                break;
            } else {
                *around = around.union(&rect);
                rect = *around;
            }
            if blocks.len() == 1 {
                break;
            }
            at = block;
        }
    }

    /// Removes a proxy's box, if there is one.
    pub(super) fn remove(&mut self, proxy: u32) {
        if let Some(leaf) = self.leaves.get_mut(proxy as usize).filter(|leaf| **leaf != NONE) {
            let at = *leaf as usize;
            self.levels[0][at / BLOCK][at % BLOCK] = Rect::NOTHING;
            self.proxies[at] = NONE;
            *leaf = NONE;
            self.live = self.live.saturating_sub(1);
            self.loose = self.loose.saturating_add(1);
        }
    }

    /// Draws the levels tight when enough boxes were set to pay for it; builds anew when many are new or most are gone.
    pub(super) fn tidy(&mut self) {
        let len = self.proxies.len();
        if self.added.saturating_mul(4) > len || self.live.saturating_mul(2) < len {
            self.build();
        } else if self.loose.saturating_mul(4) > len {
            self.tighten();
        }
        self.added = 0;
    }

    fn tighten(&mut self) {
        for above in 1..self.levels.len() {
            let (below, level) = self.levels.split_at_mut(above);
            for (around, block) in level[0].as_flattened_mut().iter_mut().zip(&below[above.wrapping_sub(1)]) {
                *around = union(block);
            }
        }
        self.loose = 0;
    }

    /// Visits the proxies whose boxes overlap `rect`, and counts what it costs.
    #[inline]
    pub(super) fn search(&mut self, rect: &Rect, mut visit: impl FnMut(u32)) {
        let (mut tests, mut found) = (0usize, 0usize);
        self.visit(
            |bounds| {
                tests = tests.saturating_add(1);
                bounds.overlaps(rect)
            },
            |proxy| {
                found = found.saturating_add(1);
                visit(proxy);
            },
        );
        let fair = found.saturating_add(self.levels.len()).saturating_mul(FAIR_TESTS);
        self.waste = self.waste.saturating_add(tests).saturating_sub(fair);
        if self.waste > self.proxies.len().saturating_mul(TESTS_PER_BUILD) {
            self.build();
        }
    }

    /// Packs the leaves anew, neighbours together. About 60 ns per leaf.
    fn build(&mut self) {
        let Tree { levels, proxies, leaves, live: _, added: _, loose, waste, items, blocks, names, spare } = self;
        (*loose, *waste) = (0, 0);
        if levels.is_empty() {
            return;
        }
        let bounds = levels[0].as_flattened();
        items.extend((0..).zip(bounds).zip(&*proxies).filter(|(_, proxy)| **proxy != NONE).map(
            |((leaf, bounds), _)| {
                let middle = [0, 1].map(|axis| (bounds.min[axis] >> 1).saturating_add(bounds.max[axis] >> 1));
                Item { middle, leaf }
            },
        ));
        // Big boxes among small ones need no care: blocks of their own gained nothing with one in a hundred 20 m long
        // and with three in a hundred 60 m long, among boxes of 1.4 m.
        split(items, BLOCK.saturating_pow(8));
        blocks.clear();
        blocks.resize(items.len().div_ceil(BLOCK), [Rect::NOTHING; BLOCK]);
        names.clear();
        for (rect, item) in blocks.as_flattened_mut().iter_mut().zip(&*items) {
            let proxy = proxies[item.leaf as usize];
            *rect = bounds[item.leaf as usize];
            leaves[proxy as usize] = names.len() as u32;
            names.push(proxy);
        }
        items.clear();
        levels[0].clone_from(blocks);
        proxies.clone_from(names);
        let mut above: usize = 1;
        while levels[above.wrapping_sub(1)].len() > 1 {
            if levels.len() == above {
                levels.push(spare.pop().unwrap_or_default());
            }
            let len = levels[above.wrapping_sub(1)].len().div_ceil(BLOCK);
            levels[above].clear();
            levels[above].resize(len, [Rect::NOTHING; BLOCK]);
            above = above.saturating_add(1);
        }
        spare.extend(levels.drain(above..));
        self.tighten();
    }

    /// Orders proxies so that those near in the tree are near in the list.
    pub(super) fn sort(&self, proxies: &mut [u32]) {
        proxies.sort_unstable_by_key(|&proxy| self.leaves[proxy as usize]);
    }

    /// Visits the proxies of all leaves that `meets` accepts; it must accept every box around one that it accepts.
    #[inline]
    pub(super) fn visit(&self, mut meets: impl FnMut(&Rect) -> bool, mut visit: impl FnMut(u32)) {
        if let Some(top) = self.levels.len().checked_sub(1) {
            self.descend(top, 0, &mut meets, &mut visit);
        }
    }

    fn descend(&self, level: usize, block: usize, meets: &mut impl FnMut(&Rect) -> bool, visit: &mut impl FnMut(u32)) {
        // Beyond the last block there are boxes around nothing, which meet what is everywhere.
        let Some(boxes) = self.levels[level].get(block) else {
            return;
        };
        // All eight before the first branch.
        let mut met = 0u8;
        for (column, rect) in boxes.iter().enumerate() {
            met |= u8::from(meets(rect)) << column;
        }
        let first = block.saturating_mul(BLOCK);
        while met != 0 {
            let at = first.saturating_add(met.trailing_zeros() as usize);
            met &= met.wrapping_sub(1);
            if level > 0 {
                self.descend(level.wrapping_sub(1), at, meets, visit);
            } else if self.proxies.get(at).is_some_and(|&proxy| proxy != NONE) {
                visit(self.proxies[at]);
            }
        }
    }
}

/// The smallest box around a block.
fn union(block: &Block) -> Rect {
    block.iter().fold(Rect::NOTHING, |around, rect| around.union(rect))
}

/// Orders items so that the blocks of every level are compact: halves them across their longer side, at a multiple of
/// `part`, the greatest power of [`BLOCK`] that is less than their number.
fn split(items: &mut [Item], mut part: usize) {
    if items.len() <= BLOCK {
        return;
    }
    while part >= items.len() {
        part /= BLOCK;
    }
    let (mut least, mut most) = ([i64::MAX; 2], [i64::MIN; 2]);
    for item in &*items {
        for axis in 0..2 {
            least[axis] = least[axis].min(item.middle[axis]);
            most[axis] = most[axis].max(item.middle[axis]);
        }
    }
    let axis = usize::from(most[1].abs_diff(least[1]) > most[0].abs_diff(least[0]));
    let half = (items.len().div_ceil(part) / 2).saturating_mul(part);
    items.select_nth_unstable_by_key(half, |item| item.middle[axis]);
    let (low, high) = items.split_at_mut(half);
    split(low, part);
    split(high, part);
}
