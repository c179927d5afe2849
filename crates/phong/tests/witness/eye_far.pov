// The pair of eye_far.toml.
#version 3.7;
global_settings { assumed_gamma 1 adc_bailout 0 max_trace_level 30 }
// From so far the rays are parallel to a millionth. Its own far eye loses what shadow rays start from.
camera {
  orthographic
  location <0, 12.699991039994355, 16.000006720000314>
  up y*4.029002541106892
  right -x*4.029002541106892*image_width/image_height // right-handed
  look_at <0, 0.7, 0>
}
background { rgb <0.05, 0.06, 0.08> }
light_source { <-3, 5, 4> rgb 0.7 }
#declare Floor = texture { pigment { rgb 0.6 } finish { ambient 0.1 diffuse 0.7 } }
plane { y, 0 texture { Floor } }
#declare Red = texture { pigment { rgb <0.8, 0.2, 0.15> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
#declare Blue = texture { pigment { rgb <0.15, 0.3, 0.8> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
#declare Yellow = texture { pigment { rgb <0.85, 0.7, 0.2> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
sphere { <-1.1, 0.8, 0>, 0.8 texture { Red } }
box { <0.2, 0, -0.9>, <1.2, 1.1, 0.1> texture { Blue } }
sphere { <0.5, 0.4, 1>, 0.4 texture { Yellow } }
