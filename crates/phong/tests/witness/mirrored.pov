// The pair of mirrored.toml.
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
plane { y, 0 texture { Floor } }
#declare Red = texture { pigment { rgb <0.8, 0.2, 0.15> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
#declare Yellow = texture { pigment { rgb <0.85, 0.7, 0.2> } finish { ambient 0.1 diffuse 0.6 phong 0.3 phong_size 20 } }
#declare Mirror = texture { pigment { rgb <0.2, 0.2, 0.2> } finish { ambient 0.1 diffuse 0.3 phong 0.3 phong_size 20 reflection { 0.6 } } }
#declare Things = union {
  sphere { <-0.9, 0.4, 0.6>, 0.4 texture { Red } }
  cone { <0, 0, 0>, 0.5, <0, 1.2, 0>, 0.1 texture { Yellow } rotate z*20 translate <-0.9, 0.4, -0.6> }
  box { <-0.4, 0, -0.4>, <0.1, 1, 0.3> texture { Mirror } rotate y*25 translate <-1.9, 0, 0> }
}
object { Things }
object { Things scale <-1, 1, 1> translate <0.4, 0, 0> }
