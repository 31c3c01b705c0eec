// Light, background, walls, glass, and the way to 8-bit sRGB. A pixel whose four samples see the same face is shaded
// once; any other is shaded four times, so silhouettes and edges are smooth at a fraction of the cost.

uniform usampler2D tags;
uniform sampler2D occlusion;
uniform sampler2DShadow shadow_map;
uniform sampler2D shadow_depths;  // the same, as numbers
out vec4 color;

const vec3 key_light = vec3(1.0, 0.97, 0.93) * 0.92;
const vec3 sky_light = vec3(0.88, 0.94, 1.0) * 0.46;
const vec3 ground_light = vec3(1.0, 0.95, 0.89) * 0.22;

vec3 background(vec3 ray) {
  float height = dot(normalize(ray), world_up.xyz);
  return mix(horizon.rgb, zenith.rgb, smoothstep(0.0, 0.9, height)) * (1.0 - 0.25 * smoothstep(0.0, -0.9, height));
}

// Share of the key light, a disc, that arrives (Fernando 2005, "Percentage-closer soft shadows"): the mean depth of
// what stands in the way gives the width of the penumbra, and so of the filter. The comparisons follow the plane of
// the surface, so a wide filter does not shade it with itself. The taps lie on a sunflower spiral turned by `phase`;
// pixels that are shaded four times take a quarter of them each time.
float lit_share(Surface s, float facing, int samples, float phase) {
  vec3 place = shadow_place(s.position + s.normal * to_light.w * (1.5 + 2.5 * (1.0 - facing)));
  if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) return 1.0;
  vec2 slope = vec2(dot(s.normal, shadow[0].xyz), dot(s.normal, shadow[1].xyz)) *
               (length(shadow[2].xyz) / (dot(shadow[0].xyz, shadow[0].xyz) * max(facing, 0.15)));
  const mat2 golden = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
  float texel = 1.0 / float(textureSize(shadow_depths, 0).x);
  float reach = clamp(penumbra.x * (place.z - penumbra.y), 1.5 * texel, 0.1);

  int taps = samples == 1 ? 12 : 5;
  vec2 turn = vec2(cos(phase), sin(phase));
  float depths = 0.0, blockers = 0.0;
  for (int k = 0; k < taps; ++k, turn = golden * turn) {
    vec2 aside = reach * sqrt((float(k) + 0.5) / float(taps)) * turn;
    float depth = texture(shadow_depths, place.xy + aside).r;
    bool blocks = depth < place.z + dot(slope, aside);
    depths += blocks ? depth : 0.0;
    blockers += blocks ? 1.0 : 0.0;
  }
  if (blockers == 0.0) return 1.0;

  taps = samples == 1 ? 28 : 8;
  float radius = clamp(penumbra.x * (place.z - depths / blockers), 1.2 * texel, reach);
  float sum = 0.0;
  for (int k = 0; k < taps; ++k, turn = golden * turn) {
    vec2 aside = radius * sqrt((float(k) + 0.5) / float(taps)) * turn;
    sum += texture(shadow_map, vec3(place.xy + aside, place.z + dot(slope, aside)));
  }
  return sum / float(taps);
}

vec3 lit(Surface s, vec3 ray, float open, int samples, float phase) {
  vec3 to_eye = -normalize(ray);
  float facing = max(dot(s.normal, to_light.xyz), 0.0);
  float key = facing > 0.0 ? facing * lit_share(s, facing, samples, phase) : 0.0;
  vec3 ambient = mix(ground_light, sky_light, 0.5 + 0.5 * dot(s.normal, world_up.xyz)) * open;
  vec3 halfway = normalize(to_light.xyz + to_eye);
  float highlight = pow(max(dot(s.normal, halfway), 0.0), 60.0) * 0.35;
  float rim = pow(1.0 - max(dot(s.normal, to_eye), 0.0), 4.0) * 0.10 * open;
  return s.albedo * (ambient + key_light * key) +
         s.gloss * (highlight * key * key_light + rim * sky_light);
}

// Walls seen from inside: a film with the lines of the grid, thinning out away from the scene.
vec3 behind_walls(vec3 seen, vec3 ray, float depth) {
  for (int wall = begin.w; wall < after.x; ++wall) {
    float wall_depth = plane_depth(wall, ray);
    if (wall_depth < forward.w || (depth > 0.0 && wall_depth > depth)) continue;
    vec3 position = wall_depth * ray;
    float film = 0.10 + 0.22 * grid(wall, position, ray);
    seen = mix(seen, 0.6 * horizon.rgb, film * (1.0 - smoothstep(0.2, 1.2, distance(position, focus.xyz) / focus.w)));
  }
  return seen;
}

// A place where a ray passes the glass of a tube, given in the tube's frame: thicker along the rims, and where the ray
// grazes it.
vec3 behind_glass(vec3 seen, int tube, TubeSpan s, float depth, bool at_cap) {
  vec3 local = s.eye + depth * s.direction;
  vec2 to_rim = vec2(length(local.xy) / texel_of(tube, 0).w, abs(local.z) / texel_of(tube, 2).z);
  float width = max(0.012, 1.2 * pixel_at(depth) / texel_of(tube, 0).w);
  float rim = smoothstep(1.0 - 2.0 * width, 1.0 - width, at_cap ? to_rim.x : to_rim.y);
  vec3 normal = at_cap ? vec3(0.0, 0.0, 1.0) : vec3(normalize(local.xy), 0.0);
  float grazing = 1.0 - abs(dot(normal, normalize(s.direction)));
  return mix(seen, 0.55 * horizon.rgb, 0.05 + 0.25 * pow(grazing, 3.0) + 0.3 * rim);
}

vec3 behind_tubes(vec3 seen, vec3 ray, float depth) {
  for (int tube = begin.y; tube < begin.z; ++tube) {
    TubeSpan s = tube_span(tube, ray);
    if (s.entry >= s.leave) continue;
    bool in_front = depth < 0.0 || s.leave < depth;
    if (s.leaves_at_cap && s.leave > forward.w && in_front) seen = behind_glass(seen, tube, s, s.leave, true);
    in_front = depth < 0.0 || s.entry < depth;
    if (s.entry > forward.w && in_front) seen = behind_glass(seen, tube, s, s.entry, s.enters_at_cap);
  }
  return seen;
}

// Whether an edge of a tube's glass passes through the pixel.
bool on_glass_edge(ivec2 pixel) {
  for (int tube = begin.y; tube < begin.z; ++tube) {
    int inside = 0, caps = 0;
    for (int k = 0; k < 4; ++k) {
      TubeSpan s = tube_span(tube, ray_through(2.0 * vec2(pixel) + vec2(float(k & 1), float(k >> 1)) + 0.5));
      if (s.entry >= s.leave) continue;
      ++inside;
      caps += (s.enters_at_cap ? 1 : 0) + (s.leaves_at_cap ? 8 : 0);
    }
    if (inside % 4 != 0 || (caps & 7) % 4 != 0 || (caps >> 3) % 4 != 0) return true;
  }
  return false;
}

vec3 shaded(uint tag, vec3 ray, float open, int samples, float phase) {
  vec3 seen = background(ray);
  Surface s = surface_of(tag, ray);
  if (s.depth > 0.0) seen = mix(lit(s, ray, open, samples, phase), seen, s.fade);
  return behind_tubes(behind_walls(seen, ray, s.depth), ray, s.depth);
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

// A fixed pattern of 0 to 1 in which neighbours differ most (Jimenez 2014, "Next generation post processing in Call of
// Duty: Advanced Warfare", interleaved gradient noise): it turns the taps of shadows, and as half a step of 8 bits up
// or down it keeps the background's gradient from banding.
float pattern(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uvec4 tag = uvec4(texelFetch(tags, 2 * pixel, 0).r, texelFetch(tags, 2 * pixel + ivec2(1, 0), 0).r,
                    texelFetch(tags, 2 * pixel + ivec2(0, 1), 0).r, texelFetch(tags, 2 * pixel + ivec2(1, 1), 0).r);
  int samples = all(equal(tag.xxx, tag.yzw)) && !on_glass_edge(pixel) ? 1 : 4;
  float open = texelFetch(occlusion, pixel, 0).r;
  float noise = pattern(vec2(pixel)), phase = 6.2831853 * noise;
  vec3 sum = vec3(0.0);
  for (int k = 0; k < samples; ++k) {
    vec2 place = samples == 1 ? vec2(1.0) : vec2(float(k & 1), float(k >> 1)) + 0.5;
    sum += shaded(tag[k], ray_through(2.0 * vec2(pixel) + place), open, samples, phase + 1.5707963 * float(k));
  }
  color = vec4(encoded(toned(sum / float(samples))) + (noise - 0.5) / 255.0, 1.0);
}
