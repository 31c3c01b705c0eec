// Where a ray from the eye enters a sphere, in depth; negative if it misses. The distance of the centre from the
// ray is found from the vector between them, not from a difference of squares, which would cancel far away.
float sphere_depth(vec4 sphere, vec3 ray) {
  float inverse = 1.0 / dot(ray, ray);
  float middle = dot(ray, sphere.xyz) * inverse;
  vec3 aside = sphere.xyz - middle * ray;
  float half_chord_squared = (sphere.w * sphere.w - dot(aside, aside)) * inverse;
  return half_chord_squared < 0.0 ? -1.0 : middle - sqrt(half_chord_squared);
}
