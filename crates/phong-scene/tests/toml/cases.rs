//! One test a file; the names are the files' names.

use std::collections::BTreeSet;
use std::fs;

macro_rules! cases {
    ($folder:ident: $($name:ident)*) => {
        mod $folder {
            $(#[test] fn $name() { crate::$folder(stringify!($name)); })*

            #[test]
            fn every_file_is_a_test() {
                super::assert_files(stringify!($folder), &[$(stringify!($name)),*]);
            }
        }
    };
}

cases! {
    good:
    a_background_may_be_transparent
    a_background_may_run_from_top_to_bottom
    a_byte_order_mark_and_line_ends_of_windows_do_no_harm
    a_fisheye_may_see_behind_itself
    a_fisheye_sees_half_of_all_by_default
    a_gradient_may_follow_a_colour_map
    a_lens_has_an_aperture_and_a_focus
    a_light_may_shine_out_of_a_ball_that_throws_no_shadow
    a_material_called_default_is_that_of_shapes_without_one
    a_sky_may_light_the_scene
    a_model_brings_its_materials_unless_one_is_named
    a_panorama_needs_no_angle
    ambient_light_may_meet_things
    an_include_may_be_read_twice
    an_included_file_may_use_materials_of_the_scene
    a_figure_has_furniture
    an_orthographic_camera_has_a_height
    any_direction_may_be_up
    colours_are_grey_linear_hexadecimal_or_names
    cylinders_follow_the_edges_of_a_file
    clips_cut_objects_and_cap_them
    every_dialect
    every_light
    every_model
    every_shape
    fog_fades_what_is_far
    groups_come_after_those_they_hold
    inline_and_dotted_tables_are_tables
    meshes_keep_their_normals_or_are_smoothed_or_flat
    molecules_are_drawn_in_styles_and_colours
    objects_are_numbered_by_kind_in_the_order_of_the_text
    maps_show_numbers
    parameters_vary_by_textures
    patterns_have_defaults
    points_are_spheres_of_the_radius_given
    shapes_are_scaled_then_turned_then_moved
    surfaces_may_be_see_through
    the_scene_of_the_interface
    what_is_not_written_has_a_default
}

cases! {
    bad:
    a_sky_needs_its_image
    nothing_black_looks_grey
    tone_has_one_white
    tone_out_of_range_is_told
    luminance_comes_in_two_steps_or_more
    what_shines_is_a_mesh
    what_shines_is_there
    a_background_table_has_two_colours
    a_broken_model_is_told_with_the_place_that_names_it
    a_camera_must_look_somewhere
    a_camera_within_a_ball_is_a_warning
    a_clip_must_cut_along_something
    a_clip_that_leaves_a_mesh_open_is_a_warning
    a_colour_is_never_negative
    a_colour_map_that_misleads_is_a_warning
    a_colour_map_that_there_is_not_is_told
    a_dialect_must_not_contradict_the_model
    a_direction_of_zero_is_none
    a_figure_has_words_numbers_and_colours_that_make_sense
    a_file_that_is_missing_is_told_where_it_is_named
    a_legend_needs_colours_of_numbers
    a_group_that_holds_itself_is_told
    a_key_of_another_kind_is_told_so
    a_key_that_the_model_does_not_use_is_wrong
    a_light_within_a_ball_is_a_warning
    a_light_with_a_surface_has_a_side_and_a_size
    a_material_defined_twice_shows_both_places
    a_model_of_another_format_is_told_where_it_is_named
    a_scene_without_lights_is_a_warning
    a_sky_has_its_sun_by_day
    a_sun_below_the_horizon_is_told
    a_scene_without_objects_is_a_warning
    a_spot_shines_somewhere_and_ends_outside
    a_table_and_a_list_of_one_name_are_told
    a_texture_that_nothing_uses_is_a_warning
    a_transform_must_be_invertible
    a_version_that_is_not_given_is_a_warning
    a_very_long_line_is_cut_around_the_place
    a_wrong_type_says_what_is_wanted_and_what_was_found
    ambient_occlusion_out_of_range_is_told
    an_empty_file_lacks_a_camera
    an_include_of_itself_is_told
    an_include_that_comes_round_is_told
    an_included_file_has_no_camera
    an_unclosed_long_text_ends_with_its_table
    an_unclosed_table_over_lines_is_told_where_it_opens
    an_unknown_key_says_what_was_meant
    an_unknown_name_says_what_was_meant
    an_unknown_word_says_what_was_meant
    at_most_twenty_syntax_errors_are_told
    cylinders_need_edges_with_a_radius_and_a_length
    every_number_out_of_range_is_told_at_its_place
    every_syntax_error_is_told_and_everything_else_too
    facets_reflect_by_one_rule
    fog_ends_behind_where_it_starts
    fog_says_how_dense_it_is
    glass_without_a_mirror_loses_light
    groups_that_hold_one_another_are_told
    names_may_be_of_any_letters
    nan_and_infinity_are_wrong_everywhere
    numbers_that_are_bytes_or_radians_are_doubted
    one_table_and_several_are_not_the_same
    maps_of_numbers_that_they_cannot_have
    maps_show_what_there_is
    opacity_is_a_share
    patterns_of_numbers_that_they_cannot_have
    selections_and_columns_are_told_at_their_place
    shapes_that_are_none_are_told
    textures_that_are_not_there_or_do_not_fit
    the_only_version_is_one
    three_js_leaves_no_choice_of_its_switches
    up_must_not_be_antiparallel_to_the_view_along_z
    up_must_not_be_parallel_to_the_view
    what_is_required_and_missing_is_told_at_its_table
    what_nobody_uses_is_a_warning
    without_any_material_the_help_says_how_to_write_one
    words_of_other_programs_are_told_ours
}

fn assert_files(folder: &str, names: &[&str]) {
    let files = fs::read_dir(crate::folder().join(folder)).expect("the folder");
    let files: BTreeSet<String> = files
        .filter_map(|file| file.expect("a file").file_name().into_string().ok())
        .filter_map(|file| file.strip_suffix(".toml").map(str::to_owned))
        .collect();
    let names: BTreeSet<String> = names.iter().map(|&name| name.to_owned()).collect();
    assert_eq!(files, names);
}
