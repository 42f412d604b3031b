//! Translates the library's advice into command-line options.

use catchment::diagnostic::{Advice, Advised};
use catchment::landscape::Resolution;
use std::error::Error;

/// The options that carry out the advice; `None` if no option does.
pub(crate) fn flags(advice: &Advice) -> Option<String> {
    Some(match advice {
        Advice::AtMostResolution(cells) if *cells >= Resolution::LEAST => {
            format!("use at most --resolution {cells}")
        }
        Advice::AtMostSamples(poses) if *poses > 0 => format!("use at most --samples {poses}"),
        Advice::CoarserGrid => "lower --resolution".to_owned(),
        Advice::FewerPoses => "try fewer poses at a time".to_owned(),
        Advice::FewerSlices => "use fewer --slices or --strips".to_owned(),
        Advice::FewerThreads => "use fewer --threads".to_owned(),
        Advice::FinerGrid => "raise --resolution".to_owned(),
        Advice::MissingPart => "add what is missing with --with-fixed or --with-moving".to_owned(),
        Advice::Method(name) => format!("--method {name}"),
        Advice::MoreMemory => "allow more with --memory".to_owned(),
        Advice::OwnFrames => {
            "the parts were taken as an assembly, since they are drawn beside or inside each other without overlap: if each has a frame of \
             its own, --drawn facing"
                .to_owned()
        },
        Advice::Samples => "--samples 4000, --budget 10s or --tolerance 1%".to_owned(),
        Advice::StateLayout => "--figure pair.png draws the pair; --facing-fixed, --facing-moving and --approach state how the parts lie".to_owned(),
        Advice::Words(words) => words.clone(),
        Advice::AtMostResolution(_) | Advice::AtMostSamples(_) | Advice::EnlargeErrors => return None,
    })
}

/// The options that resolve an error; searches its whole source chain for the advice.
pub(crate) fn of(error: &(dyn Error + 'static)) -> Option<String> {
    let mut next = Some(error);
    let advised = loop {
        let error = next?;
        match error.downcast_ref::<Advised>() {
            Some(advised) => break advised,
            None => next = error.source(),
        }
    };
    let message: Vec<String> = advised.0.iter().filter_map(flags).collect();
    (!message.is_empty()).then(|| message.join(", or "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment::exec::Exec;
    use catchment::method::drop::DropError;

    #[test]
    fn advice_nested_in_an_error_is_returned() {
        let needs = |advice: Vec<Advice>| {
            let small = Exec::new().with_memory_budget(1);
            let refused = small.ensure_fits("a grid", 2, |_| advice).unwrap_err();
            of(&DropError::from(refused))
        };
        let both = vec![Advice::AtMostResolution(12), Advice::MoreMemory];
        assert_eq!(needs(both).unwrap(), "use at most --resolution 12, or allow more with --memory");
        let too_few = vec![Advice::AtMostResolution(0), Advice::MoreMemory];
        assert_eq!(needs(too_few).unwrap(), "allow more with --memory");
        assert_eq!(needs(Vec::new()), None);
    }
}
