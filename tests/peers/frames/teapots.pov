// The scene of teapots.toml for POV-Ray 3.7. matte.inc and glass.inc hold the teapots as triangles in world space, as gz has placed them.
#version 3.7;

// A ray of the last level is counted and then cut: this many levels are one bounce fewer that is traced.
#ifndef (Levels) #declare Levels = 4; #end
// Branches end at the weight at which gz ends them.
global_settings { assumed_gamma 1.0 max_trace_level Levels adc_bailout 1 / 65536 }

// The minus makes the space right-handed.
camera {
  location <4.2, 5.2, 9.5>
  right <-1, 0, 0>
  up <0, 1, 0>
  angle 42
  look_at <0.6, 0.4, -0.3>
}

background { color rgb <0.35, 0.5, 0.75> }

#macro Light(Direction, Strength)
  light_source { Direction * 1000 color rgb Strength parallel point_at <0, 0, 0> }
#end
Light(<0.45, 0.8, 0.35>, 0.6)
Light(<-0.6, 0.7, 0.3>, 0.35)
Light(<0.1, 0.7, -0.7>, 0.25)

mesh2 {
  #include "matte.inc"
  texture { pigment { color rgb <0.8, 0.45, 0.2> } finish { ambient 0.1 diffuse 0.8 phong 0.5 phong_size 40 } }
}

mesh2 {
  #include "glass.inc"
  inside_vector <0, 1, 0>
  texture {
    pigment { color rgbf <0.95, 1, 0.97, 0.9> }
    finish { ambient 0 diffuse 0.05 reflection { 0, 1 fresnel on } conserve_energy }
  }
  interior { ior 1.5 }
  // Of shadow rays POV-Ray counts the surfaces that they meet. A run with Count has one for each ray.
  #ifdef (Count) no_shadow #end
}

plane {
  y, -0.001
  texture { pigment { color rgb 0.6 } finish { ambient 0.1 diffuse 0.5 reflection 0.5 } }
}
