// The pair of pov_ray.toml, drawn as a student would hand it in: 8 bits, encoded, edges smoothed.
//   povray +Ipov_ray.pov +Opov_ray.png +W96 +H72 +A0.1 +AM2 +R3 -D
// and as pov_ray.jpg with +FJ Compression=90
#version 3.7;
global_settings { assumed_gamma 1 }
camera {
  location <0, 2.2, 8>
  up y
  right -x*image_width/image_height // right-handed
  direction z*0.5/tan(radians(30)/2)
  look_at <0, 0.9, 0>
}
background { srgb <143, 183, 224>/255 }
light_source { <-4, 6, 5> rgb 0.75 }
light_source { <2000, 3000, 2000> rgb 0.35 parallel point_at 0 }
sphere {
  <-1.15, 1, 0>, 1
  pigment { srgb <200, 64, 47>/255 }
  finish { ambient 0.12 diffuse 0.75 phong 0.5 phong_size 60 }
}
sphere {
  <1.2, 0.8, 0.6>, 0.8
  pigment { srgb <47, 111, 200>/255 }
  finish { ambient 0.12 diffuse 0.6 specular 0.4 roughness 0.02 reflection { 0.15 } }
}
plane {
  y, 0
  pigment { srgb <201, 210, 220>/255 }
  finish { ambient 0.2 diffuse 0.75 }
}
