flat in vec4 sphere;
flat in uint tag;
in vec2 place;
out uint seen;

void main() {
#ifdef SHADOW
  float height_squared = 1.0 - dot(place, place);
  if (height_squared < 0.0) discard;
  gl_FragDepth = shadow_place(sphere.xyz + to_light.xyz * (sphere.w * sqrt(height_squared))).z;
#else
  float depth = sphere_depth(sphere, ray_through(gl_FragCoord.xy));
  if (depth < forward.w) discard;
  gl_FragDepth = window_depth(depth);
#endif
  seen = tag;
}
