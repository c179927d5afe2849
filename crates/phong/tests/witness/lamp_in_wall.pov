// The pair of lamp_in_wall.toml.
#version 3.7;
global_settings { assumed_gamma 1 adc_bailout 0 max_trace_level 30 }
camera {
  location <1, 2.2, 6>
  up y
  right -x*image_width/image_height // right-handed
  direction z*0.5/tan(radians(36)/2)
  look_at <0, 0.7, 0>
}
background { rgb <0.05, 0.06, 0.08> }
// A hair before the wall, which it does not light either.
light_source { <0.4, 2.1, -1.49999> rgb 0.8 }
#declare Floor = texture { pigment { rgb 0.6 } finish { ambient 0.1 diffuse 0.7 } }
plane { y, 0 texture { Floor } }
#declare Red = texture { pigment { rgb <0.8, 0.2, 0.15> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
#declare Blue = texture { pigment { rgb <0.15, 0.3, 0.8> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
#declare Yellow = texture { pigment { rgb <0.85, 0.7, 0.2> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
box { <-4, -1, -2.5>, <4, 6, -1.5> texture { Blue } }
sphere { <-1.1, 0.8, 0>, 0.8 texture { Red } }
sphere { <1, 0.6, 0.7>, 0.6 texture { Yellow } }
