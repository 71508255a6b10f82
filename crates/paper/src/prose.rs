//! What the page says in words: what agrees with the paper, what does not, and why. Every statement about a
//! number is made from the number.

use super::figures::closure::ClosureFigure;
use super::figures::cone::ConeFigure;
use super::figures::head::{Head, PAPER_ADAPTIVE, PAPER_UNIFORM};
use super::figures::shoe::Shoe;
use super::figures::view::ViewFigure;
use super::html::Findings;
use super::numbers::{Results, ratio, shd, signed, significant};
use super::statistics::{Table1Statistics, rises, spread};
use super::study::{DriftPoint, Row, SEAMS};
use crate::format::{counted, thousands};
use crate::paper_models::ELLIPSOID;

/// The few sentences at the top.
pub(super) fn brief(results: &Results) -> Vec<String> {
    let s = Table1Statistics::new(results);
    let all = s.rows.len();
    let mut lines = vec![
        format!(
            "The paper says that its method comes nearer to the limit surface than Amresh's at nearly equal face \
             counts. Here that is so in {} of {all} settings (ratio {} to {} %, median {} %).",
            s.below,
            ratio(s.ratios[0]),
            ratio(s.ratios[2]),
            ratio(s.ratios[1])
        ),
        format!(
            "Uniform refinement with its vertices moved to the limit surface, at the nearest face count, is nearer \
             still in {} of {all} settings: the paper's method leaves {} times its distance in the median.",
            s.uniform_nearer,
            significant(s.uniform_factors[1], 2)
        ),
    ];
    lines.push(format!(
        "Exact refinement, this project's own method, is nearer to the limit surface than the paper's with no more \
         faces in {} of {all} settings: the paper's method leaves {} times its distance in the median ({} to {}).",
        s.exact_nearer,
        significant(s.exact_factors[1], 2),
        significant(s.exact_factors[0], 2),
        significant(s.exact_factors[2], 2)
    ));
    if let Some(head) = results.figure_7.first() {
        lines.push(format!(
            "Three uniform steps of the 142-face head give {} faces ({} in the paper); the adaptive method gives {} \
             at π/36 ({} in the paper).",
            thousands(head.uniform_faces),
            thousands(PAPER_UNIFORM),
            thousands(head.adaptive_faces),
            thousands(PAPER_ADAPTIVE)
        ));
    }
    let (paper, pairs) = rises(drift(results), |p| Some(p.paper.shd_percent));
    lines.push(format!(
        "One more step takes the paper's method further away from the limit surface in {paper} of {pairs} cases: each \
         step's mesh becomes the control mesh of the next, with a limit surface of its own."
    ));
    lines
}

fn drift(results: &Results) -> impl Iterator<Item = &DriftPoint> + Clone {
    results.table_1.iter().flat_map(|study| &study.drift)
}

fn setting(row: &Row) -> String {
    format!(
        "{} at {}° ({} %)",
        row.model,
        row.angle_degrees,
        ratio(row.ratio_percent)
    )
}

fn joined(items: impl Iterator<Item = String>) -> String {
    items.collect::<Vec<_>>().join(", ")
}

/// Table 1.
pub(super) fn table_1(results: &Results) -> Findings {
    let s = Table1Statistics::new(results);
    let all = s.rows.len();
    let by_angle = results.settings.angles_degrees.iter().map(|&angle| {
        let at: Vec<_> = s.rows.iter().filter(|r| r.angle_degrees == angle).collect();
        let below = at.iter().filter(|r| r.ratio_percent < 99.95).count();
        format!("{below} of {} at {angle}°", at.len())
    });
    let by_angle = joined(by_angle);
    let by_angle = if results.settings.angles_degrees.len() > 1 {
        format!(" ({by_angle})")
    } else {
        String::new()
    };
    let agrees = format!(
        "The ratio is below 100 % in {} of {all} settings{by_angle}, as the paper has it for all six of its own.{}",
        s.below,
        if s.equal > 0 {
            format!(" In {} the distances are equal.", s.equal)
        } else {
            String::new()
        }
    );
    let above = if s.above.is_empty() {
        "No ratio is above 100 %.".to_owned()
    } else {
        format!(
            "The ratio is above 100 % for {}.",
            joined(s.above.iter().map(|r| setting(r)))
        )
    };
    let differs = format!(
        "{above} Uniform refinement with limit vertices, which the paper does not show, is nearer to the limit \
         surface in {} of {all} settings, in {} of them with no more faces; the paper's method leaves {} to {} times \
         its distance.",
        s.uniform_nearer,
        s.uniform_nearer_and_smaller,
        significant(s.uniform_factors[0], 2),
        significant(s.uniform_factors[2], 2)
    );
    let why = "The paper's models, thresholds and step counts are not known, and most digits of its table are lost, \
               so that only the claim about the ratio can be checked. Both adaptive methods refine the mesh of the \
               step before, whose limit surface is no longer that of the control mesh, and leave control points, \
               which do not lie on it; uniform refinement with limit vertices has neither error, but it spends faces \
               where the surface is flat."
        .to_owned();
    Findings {
        agrees,
        differs,
        why,
    }
}

/// How well the face counts of Table 1 match, and what the reference is worth.
pub(super) fn table_1_notes(results: &Results) -> Vec<String> {
    let s = Table1Statistics::new(results);
    let counts = if s.unmatched.is_empty() {
        format!(
            "Amresh's face count is within {} % of the paper's method's in every row.",
            significant(s.worst_match, 2)
        )
    } else {
        let list = s.unmatched.iter().map(|(r, off)| {
            format!(
                "{} at {}° ({} %)",
                r.model,
                r.angle_degrees,
                signed(*off, 1)
            )
        });
        format!(
            "Amresh's face count is a step function of its threshold. It could not be brought within 1 % for {}; \
             elsewhere it is.",
            joined(list)
        )
    };
    let references = results.table_1.iter().map(|study| {
        let r = study.reference;
        format!(
            "{} level {} ({} triangles)",
            study.model,
            r.level,
            thousands(r.triangles)
        )
    });
    let own = results
        .table_1
        .iter()
        .map(|study| study.reference.coarser_level_shd_percent / 3.0);
    let own = spread(own)[2];
    vec![
        counts,
        format!(
            "The limit surface is represented as in the paper by uniform refinement, with its vertices on the limit: \
             {}. The level before is within {} % of it, so that it is itself off by about a third of that, {} % \
             at most: differences below that mean nothing.",
            joined(references),
            shd(3.0 * own),
            shd(own)
        ),
        format!(
            "Each distance is the greatest found at {} samples or more a surface, all vertices among them: a lower \
             bound of the true one.",
            thousands(results.settings.samples)
        ),
    ]
}

/// Figure 2.
pub(super) fn figure_2(cone: &ConeFigure) -> Findings {
    let greatest = joined(cone.stages.iter().map(|s| format!("{:.1}°", s.greatest())));
    let turn = cone
        .stages
        .iter()
        .map(|s| s.limit_normal_turn_degrees)
        .fold(0.0, f64::max);
    let inside = cone
        .stages
        .iter()
        .filter(|s| s.greatest() <= cone.alpha_degrees)
        .count();
    Findings {
        agrees: format!(
            "The greatest angle between the face normals around vertex {} of the {} and its limit normal is {greatest} \
             from step to step; after {inside_steps} all are within the cone of {}°. The limit normal, worked out \
             afresh from each mesh, stays the same to within {turn:.0e}°.",
            cone.vertex,
            cone.model,
            cone.alpha_degrees,
            inside_steps = counted(cone.stages.len() - inside, "step", "steps"),
        ),
        differs: "Nothing: the figure is a sketch in the paper, and a measurement here.".to_owned(),
        why: "A step shrinks a ring by the subdominant eigenvalue of its matrix, and its height above the tangent \
              plane by the next smaller one: the angle falls by their ratio, a half at valence 6."
            .to_owned(),
    }
}

/// Figure 5.
pub(super) fn figure_5(figure: &ClosureFigure) -> Findings {
    let totals = figure.counts.iter().fold([0; 4], |mut sums, count| {
        for (sum, case) in sums.iter_mut().zip(count.cases) {
            *sum += case;
        }
        sums
    });
    let found = totals.iter().filter(|&&n| n > 0).count();
    let [a, b, c, d] = totals.map(thousands);
    Findings {
        agrees: format!(
            "{found} of 4 cases occur: over all steps of all models, {a} faces are left whole (a), {b} \
             bisected (b), {c} cut in three (c) and {d} in four (d).",
        ),
        differs: "The paper does not say which diagonal cuts the quadrilateral of case (c): here it is the shorter \
                  one."
            .to_owned(),
        why: "The shorter diagonal gives the better shaped triangles.".to_owned(),
    }
}

/// Figure 7.
pub(super) fn figure_7(heads: &[Head]) -> Findings {
    let each = |tell: &dyn Fn(&Head) -> String| joined(heads.iter().map(tell));
    let uniform_agrees = heads.iter().all(|head| head.uniform_faces == PAPER_UNIFORM);
    let counts = each(&|h| format!("{} for {}", thousands(h.uniform_faces), h.origin.source));
    let uniform = format!(
        "Uniform refinement gives as many faces as the paper has, {}, which the text extracted from its PDF has as 988: {counts}.",
        thousands(PAPER_UNIFORM)
    );
    let adaptive = each(&|h| {
        let off = signed(h.off_percent(), 0);
        format!(
            "{} for {} ({off} %)",
            thousands(h.adaptive_faces),
            h.origin.source
        )
    });
    let matching = each(&|h| {
        format!(
            "{:.1}° for {} ({})",
            h.matching_angle_degrees,
            h.origin.source,
            thousands(h.matching_faces)
        )
    });
    let adaptive = format!(
        "At π/36 = 5° the adaptive count is {adaptive}, where the paper has {}; that count is reached at {matching}.",
        thousands(PAPER_ADAPTIVE)
    );
    let seams = each(&|h| {
        let by_seam = h
            .by_seam
            .iter()
            .map(|(seam, faces)| format!("{} under '{seam}'", thousands(*faces)));
        format!("{} ({})", h.origin.source, joined(by_seam))
    });
    let (agrees, differs) = if uniform_agrees {
        (uniform, adaptive)
    } else {
        (
            "The pictures: the adaptive one looks like the uniform one.".to_owned(),
            format!("{uniform} {adaptive}"),
        )
    };
    let (ellipsoid, own): (Vec<&Head>, Vec<&Head>) =
        heads.iter().partition(|head| head.name == ELLIPSOID.name);
    let nearest = own
        .iter()
        .map(|head| head.off_percent().abs())
        .fold(f64::MAX, f64::min);
    let even = ellipsoid.iter().filter(|ellipsoid| ellipsoid.off_percent().abs() < nearest).map(|ellipsoid| {
        format!(
            " An ellipsoid with a head's proportions, 1 : 1.2 : 1.6, evenly faceted with as many faces, gives {}, nearest \
             to the paper's count: its head was smooth and even, as far as that can tell, where ours keep noses and ears.",
            thousands(ellipsoid.adaptive_faces)
        )
    });
    let why = format!(
        "The paper's own head of 142 faces is not to be had: these are other meshes of as many faces, and how many \
         faces exceed an angle depends on how evenly a mesh bends.{} By which vertices move at a seam, the counts \
         are {seams}.",
        even.collect::<String>()
    );
    Findings {
        agrees,
        differs,
        why,
    }
}

/// Figure 8.
pub(super) fn figure_8(shoe: &Shoe) -> Findings {
    let tell = joined(
        shoe.settings
            .iter()
            .map(|s| format!("{} at {}", thousands(s.faces), s.angle)),
    );
    let more = shoe
        .settings
        .windows(2)
        .all(|pair| pair[1].faces > pair[0].faces);
    let readings = shoe.settings.iter().map(|s| {
        let all = joined(s.readings.iter().map(|&n| thousands(n)));
        let nearest = s.readings.iter().min_by_key(|n| n.abs_diff(s.faces));
        let near = nearest.map_or(String::new(), |&n| {
            format!(
                "; the nearest to ours, {}, differs by {} %",
                thousands(n),
                signed(100.0 * (s.faces as f64 / n as f64 - 1.0), 0)
            )
        });
        format!("'{}' at {} may have been {all}{near}", s.printed, s.angle)
    });
    let agrees = if more {
        format!(
            "The smaller threshold gives more faces: {tell}, of {} for uniform refinement.",
            thousands(shoe.uniform_faces)
        )
    } else {
        format!(
            "The mesh starts from as many faces ({}).",
            thousands(shoe.control_faces)
        )
    };
    let differs = format!(
        "The paper's counts have lost digits in the text extracted from its PDF, all of them zeros as far as can be seen: {}.",
        readings.collect::<Vec<_>>().join(". ")
    );
    let against = if more {
        ""
    } else {
        " The counts do not grow as the threshold shrinks."
    };
    Findings {
        agrees,
        differs: differs + against,
        why: "The shoe of the paper is not to be had; this is another shape with as many faces."
            .to_owned(),
    }
}

/// Figure 9.
pub(super) fn figure_9(figure: &ViewFigure) -> Findings {
    let part = figure.part_of_pi;
    let tell = figure.models.iter().map(|m| {
        let faces = m.faces_at(part).unwrap_or(m.control_faces);
        let share = 100.0 * faces as f64 / m.uniform_faces as f64;
        format!(
            "{}: {} of {} faces ({share:.0} %)",
            m.name,
            thousands(faces),
            thousands(m.uniform_faces)
        )
    });
    let back = figure.models.iter().map(|m| {
        let [control, uniform, adaptive] = m.back_faces.map(thousands);
        format!(
            "{}: {adaptive} faces look away, {control} before and {uniform} after uniform refinement",
            m.name
        )
    });
    let readings = figure.models.iter().map(|m| {
        let all = joined(m.paper_adaptive_readings.iter().map(|&n| {
            format!(
                "{} ({:.0} %)",
                thousands(n),
                100.0 * n as f64 / m.paper_uniform as f64
            )
        }));
        format!(
            "{} of {} for the {}",
            all,
            thousands(m.paper_uniform),
            m.name
        )
    });
    Findings {
        agrees: format!(
            "With two steps and α = π/{part}: {}. Faces that look away are left alone, but for those cut to \
             close the silhouette at each step ({}).",
            joined(tell),
            back.collect::<Vec<_>>().join("; ")
        ),
        differs: format!("The paper's counts, their lost zeros restored, may have been: {}.", readings.collect::<Vec<_>>().join("; ")),
        why: "The paper prints neither threshold nor steps for this figure. Two steps give its sphere's uniform \
              count from 360 faces; the threshold drawn is the one of those in the table whose sphere comes nearest \
              to a reading of its adaptive count, with the dilatant factor k = 1 that the paper recommends."
            .to_owned(),
    }
}

/// The drift.
pub(super) fn drift_findings(results: &Results) -> Findings {
    let (paper, paper_pairs) = rises(drift(results), |p| Some(p.paper.shd_percent));
    let (uniform, uniform_pairs) =
        rises(drift(results), |p| p.uniform_limit.map(|m| m.shd_percent));
    let ends = results.table_1.iter().filter_map(|study| {
        let last = study.drift.last()?;
        let best = study
            .drift
            .iter()
            .map(|p| p.paper.shd_percent)
            .fold(f64::MAX, f64::min);
        Some(last.paper.shd_percent / best.max(f64::MIN_POSITIVE))
    });
    let ends: Vec<f64> = ends.collect();
    let past = ends.iter().filter(|&&factor| factor > 1.0).count();
    let worst = spread(ends.iter().copied())[2];
    let steps = results.settings.drift_steps;
    Findings {
        agrees: format!(
            "More steps ought to come nearer. Uniform refinement with limit vertices does so in {} of {uniform_pairs} \
             cases, the paper's method in {} of {paper_pairs}.",
            uniform_pairs - uniform,
            paper_pairs - paper
        ),
        differs: format!(
            "The paper does not show what more steps do. After {steps}, {past} of {} models are further away than \
             they were at best, by up to {} times.",
            ends.len(),
            significant(worst, 2)
        ),
        why: "Bisected faces change the valence of their vertices, and a mesh of other valences has another limit \
              surface: the next step heads for that one. The distance then stops falling, or grows, however many \
              faces are spent."
            .to_owned(),
    }
}

/// The seam rules.
pub(super) fn seams(results: &Results) -> String {
    let mut best = [0; SEAMS.len()];
    for study in &results.table_1 {
        let least = study
            .seams
            .iter()
            .map(|row| row.measured.shd_percent)
            .fold(f64::MAX, f64::min);
        for (wins, row) in best.iter_mut().zip(&study.seams) {
            *wins += usize::from(row.measured.shd_percent == least);
        }
    }
    let wins = joined(
        SEAMS
            .iter()
            .zip(best)
            .map(|((_, name), wins)| format!("'{name}' for {wins}")),
    );
    format!(
        "The paper does not say which vertices take their new position where divided and undivided faces meet. 'all' \
         (the default, and what the other tables use) moves every vertex of the mesh in each step; 'any' moves those \
         with at least one divided face; 'inner' those all of whose faces are divided. The least distance, of {} \
         models, comes from {wins}; ties count for each.",
        results.table_1.len()
    )
}
