// What every shader knows. Positions are in metres along the world's axes, from the eye; the depth of a point is
// its distance along the view. A ray of the camera has depth 1 per unit of its parameter.

layout(std140) uniform Frame {
  vec4 right;        // xyz: from the picture's centre to its right edge at depth 1; w: 1 / its squared length
  vec4 up;           // the same for the upper edge
  vec4 forward;      // xyz: unit; w: depth of the near plane
  vec4 shadow[3];    // dot(xyz, p) + w: place and depth of p in the shadow map, 0 to 1
  vec4 to_light;     // xyz: unit; w: size of a texel of the shadow map (m)
  vec4 world_up;     // xyz: unit; w: size of a pixel of the picture at depth 1
  vec4 focus;        // xyz: what the camera looks at; w: distance from it at which the ground begins to fade (m)
  vec4 zenith;       // rgb: linear; w: reach of the ambient occlusion (m)
  vec4 horizon;      // rgb: linear
  vec4 penumbra;     // x: its radius per unit of map depth between caster and receiver; y: depth of the first caster
  ivec4 begin;       // first of: boxes, tubes, grounds, walls; spheres begin at 0
  ivec4 after;       // first of: hidden planes, spheres that cast shadows, boxes that do; w: end of all
  ivec4 extent;      // yz: size of the picture in pixels; facets begin at after.w
};

// Four texels per body:
//   sphere  centre, radius   orientation                      -                          colour
//   box     centre           orientation                      half extents               colour
//   tube    centre, radius   orientation                      z: half length             colour
//   plane   point, level?    axis along the grid, its offset  the other axis, its offset  normal, cell of the grid
//   facet   corner, normal   corner, normal                   corner, normal             colour
// A facet's normals are in its corners' fourth components: see facet_normal().
uniform samplerBuffer bodies;

// A tag names what a sample of the picture sees: kind and box face in the high bits, then the body. 0: nothing.
const uint tag_sphere = 1u << 30, tag_box = 2u << 30, tag_plane = 3u << 30;
const uint tag_kind = 3u << 30, tag_face = 3u << 28, tag_body = (1u << 28) - 1u;
const uint tag_tube = tag_plane | 1u << 28, tag_facet = tag_plane | 2u << 28;

vec4 texel_of(int body, int k) { return texelFetch(bodies, 4 * body + k); }

vec3 rotated(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec4 conjugate(vec4 q) { return vec4(-q.xyz, q.w); }

vec3 shadow_place(vec3 p) {
  return vec3(dot(shadow[0].xyz, p), dot(shadow[1].xyz, p), dot(shadow[2].xyz, p)) +
         vec3(shadow[0].w, shadow[1].w, shadow[2].w);
}

// Depth runs from 1 at the near plane to 0 at infinity: with floats this is evenly fine in relative terms, and
// there is no far plane to choose.
float window_depth(float depth) { return forward.w / depth; }

vec4 projected(vec3 p) {
#ifdef SHADOW
  return vec4(2.0 * shadow_place(p) - 1.0, 1.0);
#else
  float depth = dot(forward.xyz, p);
  return vec4(dot(right.xyz, p) * right.w, dot(up.xyz, p) * up.w, 2.0 * forward.w - depth, depth);
#endif
}

// The ray through a place of the picture, in samples: two to a pixel along each axis.
vec3 ray_through(vec2 sample_place) {
  vec2 ndc = sample_place / vec2(extent.yz) - 1.0;
  return forward.xyz + ndc.x * right.xyz + ndc.y * up.xyz;
}

// Size of a pixel of the picture at a depth (m).
float pixel_at(float depth) { return world_up.w * depth; }
