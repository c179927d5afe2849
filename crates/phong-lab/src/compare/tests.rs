//! Numbers worked by hand, and what is no number.

use phong::image::Plane;

use super::*;

fn picture(transfer: Transfer, planes: &[(&str, &[f32])]) -> Picture {
    let planes = planes
        .iter()
        .map(|&(name, values)| Plane { name: name.to_owned(), values: values.to_vec() })
        .collect();
    Picture { size: [2, 1], planes, transfer, levels: None, lossy: None }
}

fn grey(values: &[f32]) -> Picture {
    picture(Transfer::Srgb, &[("Y", values)])
}

#[test]
fn a_picture_does_not_differ_from_itself() {
    let a = grey(&[0.25, f32::INFINITY]);
    let same = compare(&a, &a).unwrap();
    assert_eq!((same.max, same.mean, same.rms, same.over_1_255), (0.0, 0.0, 0.0, 0.0));
    assert_eq!((same.psnr, same.worst), (None, [0, 0]));
}

#[test]
fn numbers_are_those_worked_by_hand() {
    let a =
        picture(Transfer::Linear, &[("R", &[0.0, 0.5]), ("G", &[0.0, 0.0]), ("B", &[0.0, 0.0])]);
    let b =
        picture(Transfer::Linear, &[("R", &[0.0, 0.0]), ("G", &[0.0, 0.25]), ("B", &[0.0, 0.0])]);
    let found = compare(&a, &b).unwrap();
    assert_eq!(found.max, 0.5);
    assert_eq!(found.mean, 0.125);
    assert!((found.rms - (0.3125_f64 / 6.0).sqrt()).abs() < 1e-15);
    assert!((found.over_1_255 - 1.0 / 3.0).abs() < 1e-15);
    // 10 log10(19.2)
    assert!((found.psnr.unwrap() - 12.833_012_287).abs() < 1e-8);
    assert_eq!((found.worst, found.channel.as_str()), ([1, 0], "R"));
    assert_eq!(found.map, [0.0, 0.0, 0.0, 0.5, 0.25, 0.0]);
}

#[test]
fn one_level_of_eight_bits_is_not_over_one_level() {
    for level in 0..255_u8 {
        let [a, b] = [level, level + 1].map(|l| grey(&[f32::from(l) / 255.0; 2]));
        let found = compare(&a, &b).unwrap();
        assert_eq!(found.over_1_255, 0.0, "{level}");
        assert!(!exceeds(found.max, 1.0 / 255.0));
        assert!(exceeds(found.max, 0.0));
    }
}

#[test]
fn what_is_finite_in_one_picture_only_is_infinitely_different_and_in_no_mean() {
    let a = grey(&[0.25, f32::NAN]);
    let b = grey(&[0.0, 1.0]);
    let found = compare(&a, &b).unwrap();
    assert_eq!((found.max, found.worst, found.not_finite), (f64::INFINITY, [1, 0], 1));
    assert_eq!((found.mean, found.rms), (0.25, 0.25));
    assert!(found.delta_e.unwrap().max.is_finite());
    assert_eq!(found.worst_pixels[0].at, [1, 0]);
    assert_eq!(compare(&a, &a).unwrap().max, 0.0, "two NaNs do not differ");
}

#[test]
fn every_channel_is_told_by_itself() {
    let a = picture(Transfer::Linear, &[("R", &[0.5; 2]), ("G", &[0.0; 2]), ("B", &[0.0; 2])]);
    let b = picture(
        Transfer::Linear,
        &[("R", &[0.0, 0.5]), ("G", &[0.0; 2]), ("B", &[1.0; 2]), ("depth", &[1.0; 2])],
    );
    let told: Vec<_> = compare(&a, &b)
        .unwrap()
        .channels
        .into_iter()
        .map(|c| (c.name, c.max, c.mean, c.psnr.map(|psnr| (psnr * 100.0) as i32)))
        .collect();
    // 10 log10(1 / (0.25/2)) = 9.03
    assert_eq!(told[0], ("R".to_owned(), 0.5, 0.25, Some(903)));
    assert_eq!(told[1], ("G".to_owned(), 0.0, 0.0, None));
    assert_eq!(told[2], ("B".to_owned(), 1.0, 1.0, Some(0)));
    assert_eq!(told.len(), 3, "a layer of one picture is not compared");
}

#[test]
fn the_eye_sees_a_difference_in_the_dark_that_is_small_in_light() {
    let delta_e = |a: f32, b: f32| {
        let [a, b] = [a, b].map(|v| picture(Transfer::Linear, &[("Y", &[v; 2])]));
        compare(&a, &b).unwrap().delta_e.unwrap()
    };
    let (dark, bright) = (delta_e(0.0, 0.02), delta_e(0.8, 0.82));
    assert!(dark.max > 5.0 * bright.max, "{dark:?} {bright:?}");
    assert_eq!((dark.over_1, dark.worst), (1.0, [0, 0]));
    // Beyond white a display shows white.
    assert_eq!(delta_e(1.0, 7.0).max, 0.0);
}

#[test]
fn an_encoded_picture_looks_as_its_linear_one() {
    let linear = |v| picture(Transfer::Linear, &[("Y", &[v; 2])]);
    let encoded = |v: f64| grey(&[srgb_encode(v) as f32; 2]);
    let a = compare(&linear(0.2), &linear(0.3)).unwrap().delta_e.unwrap();
    let b = compare(&encoded(0.2), &encoded(0.3)).unwrap().delta_e.unwrap();
    assert!((a.max - b.max).abs() < 1e-4, "{a:?} {b:?}");
}

#[test]
fn the_worst_pixels_come_with_both_values_the_worst_first() {
    let mut a = grey(&[0.0, 0.25]);
    let mut b = grey(&[0.5, 0.5]);
    let found = compare(&a, &b).unwrap();
    let told: Vec<_> = found.worst_pixels.iter().map(|p| (p.at, p.a[0], p.b[0])).collect();
    assert_eq!(told, [([0, 0], 0.0, 0.5), ([1, 0], 0.25, 0.5)]);
    assert_eq!((found.pixels_over(0.25), found.pixels_over(0.0)), (1, 2));
    // More pixels than are told: the five worst, and of equals the first.
    for (picture, values) in [(&mut a, [0.0; 8]), (&mut b, [1., 3., 2., 3., 0., 1., 5., 4.])] {
        picture.size = [8, 1];
        picture.planes[0].values = values.to_vec();
    }
    let found = compare(&a, &b).unwrap();
    let columns: Vec<u32> = found.worst_pixels.iter().map(|p| p.at[0]).collect();
    assert_eq!(columns, [6, 7, 1, 3, 2]);
}

#[test]
fn a_missing_alpha_is_opaque() {
    let y: (&str, &[f32]) = ("Y", &[0.5, 0.5]);
    let a = picture(Transfer::Srgb, &[y]);
    let b = picture(Transfer::Srgb, &[y, ("A", &[1.0, 0.25])]);
    let found = compare(&a, &b).unwrap();
    assert_eq!((found.max, found.channel.as_str()), (0.75, "A"));
}

#[test]
fn linear_values_are_encoded_to_be_held_against_encoded_ones() {
    let a = grey(&[srgb_encode(0.5) as f32; 2]);
    let b = picture(Transfer::Linear, &[("Y", &[0.5, 0.5])]);
    assert!(compare(&a, &b).unwrap().max < 1e-7);
}

#[test]
fn pictures_of_different_size_or_without_common_channels_are_refused() {
    let mut b = grey(&[0.5, 0.5]);
    b.size = [1, 2];
    let size = CompareError::Size { a: [2, 1], b: [1, 2] };
    assert_eq!(compare(&grey(&[0.5, 0.5]), &b), Err(size));
    let depth = picture(Transfer::Linear, &[("depth", &[0.5, 0.5])]);
    assert_eq!(compare(&grey(&[0.5, 0.5]), &depth), Err(CompareError::Channels));
}
