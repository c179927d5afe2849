//! `phong eval`: a formula at given vectors.

use std::io::{self, BufRead, BufReader, IsTerminal, Write};

use phong_lab::eval::answer;
use serde_json::Value as Json;

use crate::failure::Failure;
use crate::report;

const ABOUT: &str = "\
A formula at given vectors: JSON lines in, JSON lines out.

Reads one query a line from standard input, and answers each with one line, in the same order:

  {\"id\": 1, \"model\": \"phong_spec\", \"N\": [0,0,1], \"L\": [0.6,0,0.8], \"E\": [0,0,1],
   \"params\": {\"alpha\": 5}}   (all of it on one line)
  {\"id\": 1, \"value\": 0.32768002}

or, where there is no answer, with {\"id\": 1, \"error\": \"...\"}. Vectors point away from the
surface and are unit to 0.001. The formulas are the renderer's own, in f32; values have all
their digits.";

const MODELS: &str = "\
Models, what they need, and their params:
  reflect                  N L      R = 2(L·N)N − L
  half                     L E      H = (L+E)/‖L+E‖
  lambert                  N L      max(0, N·L)
  phong_spec, blinn_spec   N L E    alpha
  phong, blinn_phong       N L E    ka kd ks alpha Ca Cd Cs: the whole sum for one light; the Cs are
                                    [r, g, b] or one number, light times material
  phong_multi              N E      ka kd ks alpha Ca lights: [{\"L\", \"Cd\", \"Cs\"}, ...]
  cos_power                         x_deg i
  modified_phong_brdf      N L E    kd ks n
  blinn_phong_brdf         N L E    kd ks n, normalisation: \"exact\" (default), \"approx\"
  F_schlick                         cos F0
  F_dielectric                      cos eta (n_t/n_i)
  F_conductor                       cos eta k
  microfacet_brdf          N L E    ndf: \"blinn\", \"beckmann\", \"ggx\"; a (exponent, m or α);
                                    G: \"separable\" (default), \"correlated\", \"vcavity\", \"implicit\";
                                    fresnel: null (default), [\"schlick\", F0], [\"conductor\", eta, k],
                                    [\"dielectric\", eta]; F0, eta, k numbers or [r, g, b]
  D_blinn                           NH n
  D_beckmann                        NH m
  D_ggx                             NH a
  lambda_beckmann                   cos m
  lambda_ggx                        cos a
  oren_nayar_qualitative   N L E    rho sigma (radians)
  oren_nayar_full          N L E    rho sigma, interreflection: true (default), false
  ward_brdf                N L E    ks ax ay X (along the grain), form: \"ward\" (default), \"gmd\"

Lobes are 0 where N·L ≤ 0, and where their own cosine is ≤ 0, also at alpha 0. BRDFs are 0 where
N·L ≤ 0 or N·E ≤ 0.

Exit code: 0 where every line has a value, 2 where one has an error; all are answered.";

/// Longest line that is read. A query of a million lights is shorter.
const LONGEST_LINE: u64 = 256 << 20;

/// A formula at given vectors: JSON lines in, JSON lines out
#[derive(Debug, clap::Args)]
#[command(long_about = ABOUT, after_help = MODELS)]
pub(crate) struct Args {}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    if io::stdin().is_terminal() {
        report::say(
            "reading queries, one JSON object a line; `phong eval --help` lists the models",
        );
    }
    let all_answered = answer_lines(BufReader::new(io::stdin().lock()), io::stdout().lock())?;
    if all_answered { Ok(()) } else { Err(Failure::Told) }
}

/// Answers every line of `queries`; whether all had a value.
fn answer_lines<R: io::Read>(
    mut queries: BufReader<R>,
    answers: impl Write,
) -> Result<bool, Failure> {
    let mut answers = io::BufWriter::new(answers);
    let mut all_answered = true;
    let mut line = Vec::new();
    loop {
        if queries.buffer().is_empty() {
            // Whoever sends queries one by one may be waiting for an answer.
            answers.flush().map_err(|e| Failure::stdout(&e))?;
        }
        line.clear();
        io::Read::take(&mut queries, LONGEST_LINE)
            .read_until(b'\n', &mut line)
            .map_err(|e| Failure::stdin(&e))?;
        if line.is_empty() {
            break;
        }
        if !line.ends_with(b"\n") && line.len() as u64 == LONGEST_LINE {
            return Err(Failure::usage("a line of more than 256 MB is no query"));
        }
        let (id, answer) = answer(&line);
        all_answered &= answer.is_ok();
        let text = match answer {
            Ok(value) => format!("{{\"id\": {id}, \"value\": {value}}}"),
            Err(error) => format!("{{\"id\": {id}, \"error\": {}}}", Json::from(error)),
        };
        writeln!(answers, "{text}").map_err(|e| Failure::stdout(&e))?;
    }
    answers.flush().map_err(|e| Failure::stdout(&e))?;
    Ok(all_answered)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The answer to one line, as text.
    fn told(line: &str) -> String {
        let mut out = Vec::new();
        answer_lines(BufReader::new(line.as_bytes()), &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[track_caller]
    fn assert_error(line: &str, error: &str) {
        let (_, answer) = answer(line.as_bytes());
        assert_eq!(answer, Err(error.to_owned()), "for {line}");
    }

    #[track_caller]
    fn assert_value(line: &str, value: &str) {
        let (_, answer) = answer(line.as_bytes());
        assert_eq!(answer, Ok(value.to_owned()), "for {line}");
    }

    /// A query of `model` with N = E = z, L = (0.6, 0, 0.8).
    fn with_params(model: &str, params: &str) -> String {
        format!(
            r#"{{"model": "{model}", "N": [0,0,1], "L": [0.6,0,0.8], "E": [0,0,1],
                 "params": {{{params}}}}}"#
        )
        .replace('\n', " ")
    }

    #[test]
    fn answers_come_in_order_one_line_each_whatever_the_query() {
        let answers = told(concat!(
            r#"{"id": 1, "model": "cos_power", "params": {"x_deg": 60, "i": 2}}"#,
            "\n\n",
            r#"{"id": ["any", {"json": 2}], "model": "reflect", "N": [0,0,1], "L": [0,0,1]}"#,
            "\r\n",
            r#"{"model": "nothing"}"#,
        ));
        let expected = concat!(
            r#"{"id": 1, "value": 0.25}"#,
            "\n",
            r#"{"id": null, "error": "an empty line: every line is one query"}"#,
            "\n",
            r#"{"id": ["any",{"json":2}], "value": [0.0, 0.0, 1.0]}"#,
            "\n",
            r#"{"id": null, "error": "no model `nothing`; `phong eval --help` lists them"}"#,
            "\n",
        );
        assert_eq!(answers, expected);
    }

    #[test]
    fn no_lines_are_no_answers() {
        assert_eq!(told(""), "");
    }

    #[test]
    fn every_answer_is_json() {
        for line in told("{\"id\": \"\\\"\\u0000\", \"model\": \"\\\"\"}\n\u{7f}\n[]\n").lines() {
            serde_json::from_str::<Json>(line).unwrap();
        }
    }

    #[test]
    fn values_have_all_their_digits_and_no_more() {
        assert_value(&with_params("phong_spec", r#""alpha": 1"#), "0.8");
        assert_value(&with_params("lambert", ""), "0.8");
        assert_value(r#"{"model": "F_schlick", "params": {"cos": 1, "F0": 1e-7}}"#, "1e-7");
        assert_value(
            r#"{"model": "half", "L": [1,0,0], "E": [0,1,0]}"#,
            "[0.70710677, 0.70710677, 0.0]",
        );
    }

    #[test]
    fn a_sum_is_told_by_channel_unless_no_colour_was() {
        let weights = r#""ka": 0.5, "kd": 0.5, "ks": 0, "alpha": 2"#;
        let grey = format!(r#"{weights}, "Ca": 0.5, "Cd": 1, "Cs": 1"#);
        assert_value(&with_params("phong", &grey), "0.65");
        let rgb = format!(r#"{weights}, "Ca": [0, 0.5, 1], "Cd": 1, "Cs": 1"#);
        assert_value(&with_params("blinn_phong", &rgb), "[0.4, 0.65, 0.9]");
        let multi = format!(
            r#"{weights}, "Ca": 0, "lights": [{{"L": [0,0,1], "Cd": 1, "Cs": 0}},
                {{"L": [0.6,0,0.8], "Cd": [1,0,0], "Cs": 0}}]"#
        );
        assert_value(&with_params("phong_multi", &multi), "[0.9, 0.5, 0.5]");
    }

    #[test]
    fn an_unknown_model_is_told_with_its_nearest_name() {
        assert_error(
            r#"{"model": "phong_spek"}"#,
            "no model `phong_spek`; did you mean `phong_spec`?",
        );
        assert_error(r#"{"model": 3}"#, "model is a text, not a number");
        assert_error("{}", "a query needs a model; `phong eval --help` lists them");
    }

    #[test]
    fn what_is_missing_is_named() {
        assert_error(r#"{"model": "lambert", "N": [0,0,1]}"#, "`lambert` needs the vector L");
        assert_error(&with_params("phong_spec", ""), "`phong_spec` needs params.alpha");
        assert_error(r#"{"model": "cos_power"}"#, "`cos_power` needs params.x_deg");
    }

    #[test]
    fn what_is_not_known_is_told_with_its_nearest_name() {
        assert_error(
            &with_params("phong_spec", r#""alpha": 1, "alhpa": 2"#),
            "`phong_spec` has no params.alhpa; did you mean `alpha`?",
        );
        assert_error(
            &with_params("phong_spec", r#""alpha": 1, "color": 2"#),
            "`phong_spec` has no params.color; it has alpha",
        );
        assert_error(
            &with_params("lambert", r#""x": 2"#),
            "`lambert` has no params.x; it has none",
        );
        assert_error(
            r#"{"model": "lambert", "parms": {}}"#,
            "a query has no `parms`; did you mean `params`?",
        );
    }

    #[test]
    fn vectors_are_unit_to_a_thousandth() {
        let lambert = |l: &str| format!(r#"{{"model": "lambert", "N": [0,0,1], "L": {l}}}"#);
        assert_value(&lambert("[0, 0, 1.0009]"), "1.0");
        assert_error(&lambert("[0, 0, 1.0011]"), "L is not a unit vector: its length is 1.0011");
        assert_error(&lambert("[0, 0, 0]"), "L is not a unit vector: its length is 0");
        assert_error(&lambert("[0, 1]"), "L has 3 components, not 2");
        assert_error(&lambert("1"), "L is a list of 3 numbers, not a number");
        assert_error(&lambert("[0, 0, \"1\"]"), "L[2] is a number, not a text");
        assert_error(&lambert("null"), "L is a list of 3 numbers, not null");
    }

    #[test]
    fn numbers_are_finite_and_in_their_range() {
        assert_error(
            r#"{"model": "F_schlick", "params": {"cos": NaN, "F0": 0}}"#,
            "NaN is not a number (column 42): all must be finite",
        );
        assert_error(
            r#"{"model": "F_schlick", "params": {"cos": -Infinity, "F0": 0}}"#,
            "Infinity is not a number (column 43): all must be finite",
        );
        assert_error(&with_params("phong_spec", r#""alpha": 1e39"#), "alpha = 1e39 is beyond f32");
        assert_error(&with_params("phong_spec", r#""alpha": -1"#), "alpha = -1 is negative");
        assert_error(
            &with_params("phong_spec", r#""alpha": "5""#),
            "alpha is a number, not a text",
        );
        assert_error(
            r#"{"model": "F_dielectric", "params": {"cos": 1.5, "eta": 1}}"#,
            "cos = 1.5 is not between 0 and 1",
        );
        assert_error(r#"{"model": "D_ggx", "params": {"NH": 1, "a": 0}}"#, "a = 0 is not positive");
        assert_error(
            r#"{"model": "lambda_ggx", "params": {"cos": 0, "a": 1}}"#,
            "the value is beyond the range of f32",
        );
    }

    #[test]
    fn opposite_directions_have_no_half_vector() {
        assert_error(
            r#"{"model": "half", "L": [0.6, 0, 0.8], "E": [-0.6, 0, -0.8]}"#,
            "L = −E: nothing is halfway between opposite directions",
        );
    }

    #[test]
    fn broken_json_is_told_where() {
        assert_error(r#"{"model" "half"}"#, "not JSON: expected `:` (column 10)");
        assert_error("[1, 2]", "a query is a JSON object, {\"model\": ..}");
        assert_error(r#"{"model": "half", "params": 3}"#, "params is an object, not a number");
    }

    #[test]
    fn a_choice_is_told_with_what_there_is_to_choose() {
        assert_error(
            &with_params("microfacet_brdf", r#""ndf": "gxx", "a": 0.5"#),
            "ndf is \"blinn\", \"beckmann\" or \"ggx\", not \"gxx\"",
        );
        assert_error(
            &with_params("microfacet_brdf", r#""ndf": "ggx", "a": 0.5, "fresnel": ["slick", 1]"#),
            "fresnel is null, [\"schlick\", F0], [\"dielectric\", eta] or [\"conductor\", eta, k]",
        );
    }
}
