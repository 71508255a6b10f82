//! Tests the nodes of a forest against a demand as they come, and keeps them until their next test.

use super::agenda::Agenda;
use super::demand::Question;
use super::forest::Forest;
use super::halt::Halt;
use super::least::Watch;

/// Tests nodes, and keeps them for later.
pub(super) struct Asking<'q, 'o> {
    pub(super) question: &'q Question,
    pub(super) agendas: [&'q mut Agenda; 2],
    pub(super) clocks: [f64; 2],
    pub(super) length: f64,
    pub(super) most: usize,
    pub(super) halt: Option<&'q mut Halt<'o>>,
}

impl Watch for Asking<'_, '_> {
    fn arrived(&mut self, forest: &Forest<'_>, node: u32) -> bool {
        let extent = &forest.extents[node as usize];
        if u32::from(extent.level) >= self.question.max_levels {
            return false;
        }
        if self.agendas[0].is_ring() {
            let answer = self.question.answer(extent, self.length);
            let clock = usize::from(answer.turns);
            self.agendas[clock].put(self.clocks[clock] + answer.margin, node, extent.stamp);
            return answer.wants;
        }
        let measure = self.question.measure(extent);
        self.agendas[0].put(measure, node, extent.stamp);
        measure > self.question.limit
    }

    fn goes_on(&mut self, forest: &Forest<'_>) -> bool {
        let is_allowed = self
            .halt
            .as_mut()
            .is_none_or(|halt| halt.goes_on(forest.triangles));
        is_allowed && forest.triangles <= self.most
    }
}
