//! What a number may have been whose zeros are lost: the text of the paper that this work started from has
//! lost digits 0, so that 9088 reads 988.

/// All numbers within `low..=high` that read as `printed` once their zeros are left out, ascending.
pub(super) fn readings(printed: &str, low: usize, high: usize) -> Vec<usize> {
    let mut found = Vec::new();
    let widest = high.to_string().len();
    let mut open = vec![(String::new(), printed)];
    while let Some((text, rest)) = open.pop() {
        if text.len() > widest {
            continue;
        }
        if rest.is_empty()
            && let Ok(number) = text.parse::<usize>()
            && (low..=high).contains(&number)
        {
            found.push(number);
        }
        if !text.is_empty() {
            open.push((format!("{text}0"), rest));
        }
        if let Some(digit) = rest.chars().next() {
            open.push((format!("{text}{digit}"), &rest[digit.len_utf8()..]));
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_readings_and_no_others() {
        let brute = |printed: &str, low: usize, high: usize| -> Vec<usize> {
            (low..=high)
                .filter(|n| n.to_string().replace('0', "") == printed.replace('0', ""))
                .collect()
        };
        for (printed, low, high) in [
            ("988", 142, 9088),
            ("188", 360, 5760),
            ("846", 684, 10_944),
            ("6626", 1, 13_280),
        ] {
            assert_eq!(
                readings(printed, low, high),
                brute(printed, low, high),
                "{printed}"
            );
        }
        assert_eq!(readings("988", 142, 9088), [988, 9088]);
    }
}
