// Depth of a plane along a ray; negative if the ray does not meet it. A level floor reaches to the horizon; any
// other plane ends where it goes behind another one, so that planes which make a box or a funnel look like it.
float plane_depth(int plane, vec3 ray) {
  vec4 point = texel_of(plane, 0);
  vec3 normal = texel_of(plane, 3).xyz;
  float depth = dot(normal, point.xyz) / dot(normal, ray);
  int others = point.w > 0.0 ? begin.z : after.y;
  for (int other = begin.z; other < others; ++other) {
    if (other == plane) continue;
    float height = dot(texel_of(other, 3).xyz, depth * ray - texel_of(other, 0).xyz);
    if (height < -1e-4 * abs(depth)) depth = -1.0;
  }
  return depth;
}
