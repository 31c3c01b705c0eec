// One triangle around the silhouette of each sphere. Seen from the eye, the silhouette is the circle in which the
// tangent cone meets the plane through the centre at right angles to the line of sight.

flat out vec4 sphere;
flat out uint tag;
out vec2 place;  // in the plane of the triangle, from the centre, in radii of the circle

void main() {
#ifdef SHADOW
  int body = after.y + gl_VertexID / 3;
#else
  int body = gl_VertexID / 3;
#endif
  sphere = texel_of(body, 0);
  tag = tag_sphere | uint(body);
  float corner = float(gl_VertexID % 3) * 2.0943951 + 1.5707963;
  place = 2.0 * vec2(cos(corner), sin(corner));
#ifdef SHADOW
  vec3 axis = to_light.xyz;
  float radius = sphere.w;
#else
  float distance_squared = dot(sphere.xyz, sphere.xyz);
  float share = sphere.w * sphere.w / distance_squared;
  vec3 axis = sphere.xyz * inversesqrt(distance_squared);
  float radius = sphere.w * inversesqrt(1.0 - min(share, 0.9999));
#endif
  vec3 a = normalize(cross(axis, abs(axis.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 b = cross(axis, a);
  gl_Position = projected(sphere.xyz + radius * (place.x * a + place.y * b));
#ifndef SHADOW
  // From inside there is nothing to see.
  if (share >= 1.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
#endif
}
