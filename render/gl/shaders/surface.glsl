// What a sample of the picture sees, from its tag and its ray alone: hits are found again exactly rather than
// stored, so the first pass writes nothing but tags.

struct Surface {
  float depth;  // negative: there is nothing
  vec3 position;
  vec3 normal;
  vec3 albedo;
  float gloss;  // strength of the highlight
  float fade;   // 1 where the background takes over
};

Surface sphere_surface(int body, vec3 ray) {
  vec4 sphere = texel_of(body, 0);
  float depth = sphere_depth(sphere, ray);
  vec3 normal = (depth * ray - sphere.xyz) / sphere.w;
  // Four lunes in two shades show how the sphere turns; they go where a sphere is only some pixels wide.
  vec3 local = rotated(conjugate(texel_of(body, 1)), normal);
  float pixel = pixel_at(depth) / sphere.w;
  vec2 side = clamp(local.xy / (1.2 * pixel), -1.0, 1.0);
  float shade = 1.0 + 0.085 * side.x * side.y * smoothstep(0.16, 0.05, pixel);
  return Surface(depth, depth * ray, normal, shade * texel_of(body, 3).rgb, 0.6, 0.0);
}

Surface box_surface(int body, vec3 ray) {
  vec4 to_world = texel_of(body, 1);
  vec3 half_extents = texel_of(body, 2).xyz;
  vec3 eye = rotated(conjugate(to_world), -texel_of(body, 0).xyz);
  vec3 direction = rotated(conjugate(to_world), ray);
  vec3 near = (-sign(direction) * half_extents - eye) / direction;
  int axis = near.x > near.y ? (near.x > near.z ? 0 : 2) : (near.y > near.z ? 1 : 2);
  float depth = near[axis];
  vec3 local = eye + depth * direction;
  // Within a narrow rim the normal leans outward, as on a chamfered edge: it catches the light differently from
  // both faces, and boxes of one colour part.
  float rim = 0.07 * min(half_extents.x, min(half_extents.y, half_extents.z));
  vec3 lean = clamp(1.0 - (half_extents - abs(local)) / rim, 0.0, 1.0);
  lean[axis] = 1.0;
  vec3 normal = normalize(lean * lean * sign(local));
  return Surface(depth, depth * ray, rotated(to_world, normal), texel_of(body, 3).rgb, 0.35, 0.0);
}

// Share of a pixel `width` wide at x that lines of `thickness` at every multiple of 1 cover.
float lines(float x, float thickness, float width) {
  float aside = abs(x - round(x));
  float covered = clamp((0.5 * (thickness + width) - aside) / width, 0.0, 1.0) * min(1.0, thickness / width);
  return mix(covered, thickness, smoothstep(0.25, 0.8, width));
}

// Lines of the grid of a plane, the bolder ones every 10 cells.
float grid(int plane, vec3 position, vec3 ray) {
  vec4 normal = texel_of(plane, 3);
  float covered = 0.0;
  for (int k = 1; k <= 2; ++k) {
    vec4 axis = texel_of(plane, k);
    float x = (dot(axis.xyz, position) + axis.w) / normal.w;
    float width = pixel_at(dot(forward.xyz, position)) / normal.w *
                  length(axis.xyz - normal.xyz * (dot(axis.xyz, ray) / dot(normal.xyz, ray)));
    float fine = 0.6 * lines(x, 0.022, width);
    covered = max(covered, max(fine, lines(0.1 * x, 0.0036, 0.1 * width)));
  }
  return covered;
}

float fade_at(vec3 position) {
  return smoothstep(focus.w, 4.0 * focus.w, distance(position, focus.xyz));
}

Surface plane_surface(int plane, vec3 ray) {
  float depth = plane_depth(plane, ray);
  vec3 position = depth * ray;
  vec3 albedo = vec3(0.62, 0.615, 0.605) * (1.0 - 0.5 * grid(plane, position, ray));
  return Surface(depth, position, texel_of(plane, 3).xyz, albedo, 0.0, fade_at(position));
}

// The inside of the wall. Staves in two shades, one of them marked, show how the tube turns.
Surface tube_surface(int body, vec3 ray) {
  const float staves = 24.0;
  TubeSpan s = tube_span(body, ray);
  vec2 local = s.eye.xy + s.leave * s.direction.xy;
  vec3 normal = rotated(texel_of(body, 1), vec3(-normalize(local), 0.0));
  float stave = atan(local.y, local.x) * staves / 6.2831853;
  float steep = max(dot(normal, -normalize(ray)), 0.1);
  float width = pixel_at(s.leave) / (texel_of(body, 0).w * steep) * staves / 6.2831853;
  float light = 0.5 + clamp((0.25 - abs(fract(stave) - 0.5)) / width, -0.5, 0.5);
  float marked = clamp((0.25 - abs(stave - 0.5)) / width + 0.5, 0.0, 1.0);
  vec3 albedo = texel_of(body, 3).rgb * (0.72 + 0.28 * light);
  albedo = mix(albedo, vec3(0.79, 0.35, 0.0), marked);
  return Surface(s.leave, s.leave * ray, normal, albedo, 0.1, 0.0);
}

// Twelve bits for each of two coordinates on an octahedron (Cigolle et al. 2014, "A survey of efficient
// representations for independent unit vectors").
vec3 facet_normal(float code) {
  float high = floor(code / 4096.0);
  vec2 p = vec2(high, code - 4096.0 * high) / 2047.5 - 1.0;
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}

// A triangle; with the normals of its corners it passes for a part of a curved surface.
Surface facet_surface(int body, vec3 ray) {
  vec4 a = texel_of(body, 0), b = texel_of(body, 1), c = texel_of(body, 2);
  vec3 across = cross(b.xyz - a.xyz, c.xyz - a.xyz);
  float depth = dot(across, a.xyz) / dot(across, ray);
  vec3 position = depth * ray;
  vec3 share = vec3(dot(across, cross(b.xyz - position, c.xyz - position)),
                    dot(across, cross(c.xyz - position, a.xyz - position)),
                    dot(across, cross(a.xyz - position, b.xyz - position))) /
               dot(across, across);
  vec3 normal = normalize(share.x * facet_normal(a.w) + share.y * facet_normal(b.w) + share.z * facet_normal(c.w));
  if (dot(across, ray) * dot(across, normal) > 0.0) normal = -normal;
  vec4 color = texel_of(body, 3);
  return Surface(depth, position, normal, color.rgb, color.a, 0.0);
}

Surface surface_of(uint tag, vec3 ray) {
  int body = int(tag & tag_body);
  uint kind = tag & tag_kind;
  if ((tag & (tag_kind | tag_face)) == tag_tube) return tube_surface(body, ray);
  if ((tag & (tag_kind | tag_face)) == tag_facet) return facet_surface(body, ray);
  if (kind == tag_sphere) return sphere_surface(body, ray);
  if (kind == tag_box) return box_surface(body, ray);
  if (kind == tag_plane) return plane_surface(body, ray);
  return Surface(-1.0, vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 1.0);
}
