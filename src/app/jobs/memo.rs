//! A value kept with the inputs it was made from.

use std::sync::atomic::{AtomicU64, Ordering};

/// A derived value that is made anew only when its inputs are others than before.
///
/// The key holds every input: what is left out of it shows stale.
#[derive(Debug)]
pub struct Memo<K, V> {
    made: Option<(K, V)>,
    stamp: u64,
}

/// The stamp of the value that was made last.
static LAST_STAMP: AtomicU64 = AtomicU64::new(0);

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self { made: None, stamp: 0 }
    }
}

impl<K: PartialEq, V> Memo<K, V> {
    /// Sees to it that the value belongs to these inputs; tells whether it had to be made.
    pub fn refresh(&mut self, key: K, make: impl FnOnce(&K) -> V) -> bool {
        if self.made.as_ref().is_some_and(|(made_from, _)| *made_from == key) {
            return false;
        }
        let value = make(&key);
        self.made = Some((key, value));
        self.stamp = LAST_STAMP.fetch_add(1, Ordering::Relaxed) + 1;
        true
    }

    /// The value, if it was ever made.
    pub fn get(&self) -> Option<&V> {
        self.made.as_ref().map(|(_, value)| value)
    }

    /// The inputs of the value.
    pub fn key(&self) -> Option<&K> {
        self.made.as_ref().map(|(key, _)| key)
    }

    /// Another number for every value that was ever made, 0 without one: what is made from this
    /// value has it in its key.
    pub fn stamp(&self) -> u64 {
        self.stamp
    }

    /// Lets go of the value, where nobody looks at it any more.
    pub fn clear(&mut self) {
        self.made = None;
        self.stamp = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::Memo;

    #[test]
    fn a_value_is_made_once_for_the_same_inputs() {
        let mut made = 0;
        let mut memo = Memo::default();
        for key in [1, 1, 2, 2, 2, 1] {
            memo.refresh(key, |key| {
                made += 1;
                key * 10
            });
            assert_eq!(memo.get(), Some(&(key * 10)));
        }
        assert_eq!(made, 3);
    }

    #[test]
    fn inputs_that_are_not_numbers_do_not_loop_for_ever_in_one_refresh() {
        // NaN differs from itself: the value is made anew at each refresh, which is slow and right.
        let mut memo = Memo::default();
        assert!(memo.refresh(f64::NAN, |_| 1));
        assert!(memo.refresh(f64::NAN, |_| 2));
        assert_eq!(memo.get(), Some(&2));
    }
}
