// A ray through the inside of a tube, in the tube's frame.
struct TubeSpan {
  vec3 eye, direction;
  float entry, leave;            // depths; it misses the tube unless entry < leave
  bool enters_at_cap, leaves_at_cap;
};

TubeSpan tube_span(int body, vec3 ray) {
  vec4 centre = texel_of(body, 0);
  vec4 to_tube = conjugate(texel_of(body, 1));
  float half_length = texel_of(body, 2).z;
  TubeSpan s;
  s.eye = rotated(to_tube, -centre.xyz);
  s.direction = rotated(to_tube, ray);
  // As for spheres, the distance from the axis comes from the vector across it.
  float inverse = 1.0 / max(dot(s.direction.xy, s.direction.xy), 1e-20);
  float middle = -dot(s.eye.xy, s.direction.xy) * inverse;
  vec2 aside = s.eye.xy + middle * s.direction.xy;
  float half_chord_squared = (centre.w * centre.w - dot(aside, aside)) * inverse;
  float half_chord = half_chord_squared < 0.0 ? -1.0 : sqrt(half_chord_squared);
  vec2 wall = middle + half_chord * vec2(-1.0, 1.0);
  vec2 caps = ((s.direction.z < 0.0 ? vec2(1.0, -1.0) : vec2(-1.0, 1.0)) * half_length - s.eye.z) / s.direction.z;
  s.enters_at_cap = caps.x > wall.x;
  s.leaves_at_cap = caps.y < wall.y;
  s.entry = max(wall.x, caps.x);
  s.leave = min(wall.y, caps.y);
  return s;
}
