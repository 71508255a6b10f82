//! Where results go without a name, and that inputs are not lost to them.

use std::path::Path;

use crate::common::{TETRAHEDRON, bytes, done, file, folder, names, text, usage_error};

fn is_unchanged(input: &Path) -> bool {
    text(input) == TETRAHEDRON
}

#[test]
fn a_result_without_a_name_stands_by_its_input_as_smooth() {
    let folder = folder();
    let inputs = ["a.obj", "b.obj"].map(|name| file(&folder, name, TETRAHEDRON));
    done("refine {} --tolerance 5%", &[&inputs[0]]).saying("a-smooth.obj");
    assert_eq!(names(folder.path()), ["a-smooth.obj", "a.obj", "b.obj"]);
    // Several, in another format; what is there of an earlier run is replaced.
    done(
        "refine {} {} --tolerance 5% --to stl",
        &[&inputs[0], &inputs[1]],
    )
    .saying("b-smooth.stl");
    done("refine {} {} --tolerance 5%", &[&inputs[0], &inputs[1]]);
    let all = [
        "a-smooth.obj",
        "a-smooth.stl",
        "a.obj",
        "b-smooth.obj",
        "b-smooth.stl",
        "b.obj",
    ];
    assert_eq!(names(folder.path()), all);
    assert!(inputs.iter().all(|input| is_unchanged(input)));
    done("refine {} --dry-run", &[&inputs[0]]);
    assert_eq!(names(folder.path()), all);
    usage_error("refine - --from obj", &[], "--output FILE names it");
}

#[test]
fn a_built_in_model_without_a_name_goes_to_the_current_folder() {
    let folder = folder();
    let status = crate::common::command("refine builtin:tetrahedron --tolerance 5% --quiet", &[])
        .current_dir(folder.path())
        .status();
    assert!(status.expect("it runs").success());
    assert_eq!(names(folder.path()), ["tetrahedron-smooth.ply"]);
}

#[test]
fn an_input_is_replaced_only_where_that_is_asked_for() {
    let folder = folder();
    let input = file(&folder, "a.obj", TETRAHEDRON);
    let other = file(&folder, "b.obj", TETRAHEDRON);
    let dotted = folder.path().join(".").join("a.obj");
    let refused = |words: &str, paths: &[&Path]| {
        usage_error(
            words,
            paths,
            "is an input, which the result would replace; --overwrite",
        );
        assert!(is_unchanged(&input) && is_unchanged(&other), "{words}");
    };
    refused("refine {} -o {} --tolerance 5%", &[&input, &input]);
    refused("refine {} -o {} --tolerance 5%", &[&input, &dotted]);
    refused(
        "refine {} {} -o {} --tolerance 5%",
        &[&input, &other, folder.path()],
    );
    refused(
        "refine {} {} -o {} --shared-topology --tolerance 5%",
        &[&input, &other, folder.path()],
    );
    #[cfg(unix)]
    {
        let link = folder.path().join("link.obj");
        std::os::unix::fs::symlink(&input, &link).expect("a link");
        refused("refine {} -o {} --tolerance 5%", &[&input, &link]);
        refused("refine {} -o {} --tolerance 5%", &[&link, &input]);
    }
    let hard = folder.path().join("hard.obj");
    std::fs::hard_link(&input, &hard).expect("a link");
    refused("refine {} -o {} --tolerance 5%", &[&input, &hard]);
    // Another input would be gone before it is read.
    let smooth = file(&folder, "a-smooth.obj", TETRAHEDRON);
    usage_error(
        "refine {} {} --tolerance 5% --overwrite",
        &[&input, &smooth],
        "is an input, too",
    );
    assert!(is_unchanged(&smooth));
    let ply = folder.path().join("c.ply");
    done("refine {} -o {} --tolerance 5%", &[&input, &ply]);
    let before = bytes(&ply);
    let words = "is an input, which the result would replace";
    usage_error("project {} --onto {} -o {}", &[&ply, &input, &ply], words);
    usage_error(
        "measure {} {} --heatmap {}",
        &[&ply, &input, &ply],
        "is an input",
    );
    assert_eq!(bytes(&ply), before);

    done(
        "refine {} {} -o {} --tolerance 5% --overwrite",
        &[&input, &other, folder.path()],
    );
    assert!(!is_unchanged(&input) && !is_unchanged(&other));
    done(
        "project {} --onto {} -o {} --overwrite",
        &[&ply, &input, &ply],
    );
}
