use super::*;

#[test]
fn numbers_that_are_no_image_are_told() {
    let bytes = |n: usize| TexelValues::Bytes(vec![0; n]);
    let error = |size, channels, values| Texels::new(size, channels, values).unwrap_err();
    assert_eq!(error([0, 3], 1, bytes(0)), TexelsError::Empty([0, 3]));
    assert_eq!(error([1, 1], 5, bytes(5)), TexelsError::Channels(5));
    assert_eq!(error([2, 2], 3, bytes(9)), TexelsError::Count { found: 9, wanted: 12 });
    let floats = TexelValues::Floats(vec![0.0, 1.0, f32::INFINITY, 2.0]);
    let wrong = TexelsError::NotFinite { at: [0, 1], value: f32::INFINITY };
    assert_eq!(error([2, 2], 1, floats), wrong);
}

#[test]
fn grey_is_all_three_colours_and_opacity_is_never_decoded() {
    let texels = Texels::new([1, 1], 2, TexelValues::Bytes(vec![188, 128])).unwrap();
    let [r, g, b, opacity] = texels.get([0, 0], true);
    assert!(r == g && g == b && (r - 0.5029).abs() < 1e-4, "{r}");
    assert_eq!(opacity, 128.0 / 255.0);
    assert_eq!(texels.get([0, 0], false)[0], 188.0 / 255.0);
}

#[test]
fn half_an_image_is_the_mean_of_light_not_of_codes() {
    let texels = Texels::new([2, 1], 1, TexelValues::Bytes(vec![0, 255])).unwrap();
    let half = |srgb| texels.half(srgb).unwrap().get([0, 0], srgb)[0];
    assert!((half(true) - 0.5).abs() < 0.01);
    assert!((half(false) - 0.5).abs() < 0.01);
    let code = |srgb| match texels.half(srgb).unwrap().values() {
        TexelValues::Bytes(values) => values[0],
        other => panic!("{other:?}"),
    };
    assert_eq!([code(true), code(false)], [188, 128]);
    assert!(texels.half(true).unwrap().half(true).is_none());
}
