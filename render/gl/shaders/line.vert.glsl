// Lines over the picture: two triangles each, wider by a pixel on all sides for smooth edges.

flat out float half_width;
flat out vec4 line_color;
flat out float where_hidden;
noperspective out float across;  // pixels from the middle
out float depth;

uniform samplerBuffer lines;

void main() {
  int line = gl_VertexID / 6;
  vec4 from = texelFetch(lines, 3 * line), to = texelFetch(lines, 3 * line + 1);
  half_width = 0.5 * from.w;
  where_hidden = to.w;
  line_color = texelFetch(lines, 3 * line + 2);
  // The part in front of the near plane.
  float near = 1.001 * forward.w;
  vec2 ends = vec2(dot(forward.xyz, from.xyz), dot(forward.xyz, to.xyz));
  vec3 a = ends.x < near ? mix(from.xyz, to.xyz, clamp((near - ends.x) / (ends.y - ends.x), 0.0, 1.0)) : from.xyz;
  vec3 b = ends.y < near ? mix(to.xyz, from.xyz, clamp((near - ends.y) / (ends.x - ends.y), 0.0, 1.0)) : to.xyz;
  int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
  vec4 p = projected(a), q = projected(b);
  vec2 along = (q.xy / q.w - p.xy / p.w) * vec2(extent.yz);
  along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  float side = (corner & 1) == 0 ? -1.0 : 1.0;
  bool at_end = (corner & 2) != 0;
  vec4 place = at_end ? q : p;
  float reach = half_width + 1.0;
  vec2 shift = reach * (side * vec2(-along.y, along.x)) + (at_end ? 0.5 : -0.5) * along;
  across = side * reach;
  depth = place.w;
  gl_Position = max(ends.x, ends.y) < near ? vec4(2.0, 2.0, 2.0, 1.0)
                                           : vec4(place.xy + 2.0 * shift / vec2(extent.yz) * place.w, 0.0, place.w);
}
