// The pair of glass_touching.toml.
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
light_source { <-3, 5, 4> rgb 0.7 }
#declare Floor = texture { pigment { rgb 0.6 } finish { ambient 0.1 diffuse 0.7 } }
plane { y, 0 no_shadow texture { Floor } }
#declare Red = texture { pigment { rgb <0.8, 0.2, 0.15> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
#declare Glass = texture { pigment { rgbt <1, 1, 1, 1> } finish { ambient 0 diffuse 0 phong 0.3 phong_size 40 reflection { 0, 1 fresnel on } conserve_energy } }
#declare Yellow = texture { pigment { rgb <0.85, 0.7, 0.2> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
sphere { <-1.1, 0.8, -1.2>, 0.8 texture { Red } no_shadow }
sphere { <1.4, 0.9, -1>, 0.9 texture { Yellow } no_shadow }
// One block: two with a wall in one place would be met by chance.
box { <-1.2, 0.2, -0.6>, <0.9, 1.6, 0.5> texture { Glass } no_shadow interior { ior 1.5 } }
