// Light, background, walls, and the way to 8-bit sRGB. A pixel whose four samples see the same face is shaded
// once; any other is shaded four times, so silhouettes and edges are smooth at a fraction of the cost.

uniform usampler2D tags;
uniform sampler2D occlusion;
uniform sampler2DShadow shadow_map;
out vec4 color;

const vec3 key_light = vec3(1.0, 0.97, 0.93) * 0.92;
const vec3 sky_light = vec3(0.88, 0.94, 1.0) * 0.46;
const vec3 ground_light = vec3(1.0, 0.95, 0.89) * 0.22;

vec3 background(vec3 ray) {
  float height = dot(normalize(ray), world_up.xyz);
  return mix(horizon.rgb, zenith.rgb, smoothstep(0.0, 0.9, height)) * (1.0 - 0.25 * smoothstep(0.0, -0.9, height));
}

// Share of the key light that arrives: 9 bilinear comparisons on a 3 x 3 grid.
float lit_share(vec3 position, vec3 normal) {
  float texel = to_light.w;
  float slope = 1.0 - max(dot(normal, to_light.xyz), 0.0);
  vec3 place = shadow_place(position + normal * texel * (1.5 + 2.5 * slope));
  if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) return 1.0;
  float step_size = 1.6 / float(textureSize(shadow_map, 0).x);
  float sum = 0.0;
  for (int k = 0; k < 9; ++k) {
    vec2 aside = vec2(float(k % 3), float(k / 3)) - 1.0;
    sum += texture(shadow_map, vec3(place.xy + step_size * aside, place.z));
  }
  return sum / 9.0;
}

vec3 lit(Surface s, vec3 ray, float open) {
  vec3 to_eye = -normalize(ray);
  float facing = max(dot(s.normal, to_light.xyz), 0.0);
  float key = facing > 0.0 ? facing * lit_share(s.position, s.normal) : 0.0;
  vec3 ambient = mix(ground_light, sky_light, 0.5 + 0.5 * dot(s.normal, world_up.xyz)) * open;
  vec3 halfway = normalize(to_light.xyz + to_eye);
  float highlight = pow(max(dot(s.normal, halfway), 0.0), 60.0) * 0.35;
  float rim = pow(1.0 - max(dot(s.normal, to_eye), 0.0), 4.0) * 0.10 * open;
  return s.albedo * (ambient + key_light * key) +
         s.gloss * (highlight * key * key_light + rim * sky_light);
}

// Walls seen from inside: a film with the lines of the grid, thinning out away from the scene.
vec3 behind_walls(vec3 seen, vec3 ray, float depth) {
  for (int wall = begin.z; wall < begin.w; ++wall) {
    float wall_depth = plane_depth(wall, ray);
    if (wall_depth < forward.w || (depth > 0.0 && wall_depth > depth)) continue;
    vec3 position = wall_depth * ray;
    float film = 0.10 + 0.22 * grid(wall, position, ray);
    seen = mix(seen, 0.6 * horizon.rgb, film * (1.0 - smoothstep(0.2, 1.2, distance(position, focus.xyz) / focus.w)));
  }
  return seen;
}

vec3 shaded(uint tag, vec3 ray, float open) {
  vec3 seen = background(ray);
  Surface s = surface_of(tag, ray);
  if (s.depth > 0.0) seen = mix(lit(s, ray, open), seen, s.fade);
  return behind_walls(seen, ray, s.depth);
}

// Leaves colours as they are up to the knee and rolls the brightest channel off above it, hue kept: the shoulder
// of Khronos' PBR Neutral tone mapper.
vec3 toned(vec3 linear) {
  const float knee = 0.8;
  float peak = max(linear.r, max(linear.g, linear.b));
  if (peak <= knee) return linear;
  float rolled = 1.0 - (1.0 - knee) * (1.0 - knee) / (peak + 1.0 - 2.0 * knee);
  return mix(linear * (rolled / peak), vec3(rolled), 0.25 * (peak - rolled) / peak);
}

vec3 encoded(vec3 linear) {
  vec3 curve = 1.055 * pow(max(linear, 0.0), vec3(1.0 / 2.4)) - 0.055;
  return mix(curve, 12.92 * linear, lessThan(linear, vec3(0.0031308)));
}

// A fixed pattern of +-half a step of 8 bits keeps the background's gradient from banding (Jimenez 2014,
// "Next generation post processing in Call of Duty: Advanced Warfare", interleaved gradient noise).
float dither(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))) - 0.5; }

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uvec4 tag = uvec4(texelFetch(tags, 2 * pixel, 0).r, texelFetch(tags, 2 * pixel + ivec2(1, 0), 0).r,
                    texelFetch(tags, 2 * pixel + ivec2(0, 1), 0).r, texelFetch(tags, 2 * pixel + ivec2(1, 1), 0).r);
  int samples = all(equal(tag.xxx, tag.yzw)) ? 1 : 4;
  float open = texelFetch(occlusion, pixel, 0).r;
  vec3 sum = vec3(0.0);
  for (int k = 0; k < samples; ++k) {
    vec2 place = samples == 1 ? vec2(1.0) : vec2(float(k & 1), float(k >> 1)) + 0.5;
    sum += shaded(tag[k], ray_through(2.0 * vec2(pixel) + place), open);
  }
  color = vec4(encoded(toned(sum / float(samples))) + dither(vec2(pixel)) / 255.0, 1.0);
}
