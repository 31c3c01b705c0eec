// Normal and depth once per pixel, at the first of its four samples, for the ambient occlusion.

uniform usampler2D tags;
out vec4 normal_and_depth;

void main() {
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  Surface s = surface_of(texelFetch(tags, first, 0).r, ray_through(vec2(first) + 0.5));
  normal_and_depth = vec4(s.normal, s.depth);
}
