#pragma once
/// \file
/// The shaders.
///
/// Solids are not made of triangles: for each pixel the ray through its centre is intersected with the exact box,
/// sphere, cylinder, capsule or plane. OpenGL draws a box around the solid (its back faces, a little larger than it is)
/// only to find the pixels in question. So silhouettes are those of the solid, and a depth has no error but that of
/// single precision. Meshes are triangles; the depth of a pixel is that of the triangle's plane along its ray.
///
/// The ray of a pixel is (x, 1, z) in the camera's frame, x to the right, z up, so the parameter t of a point on it is
/// the distance along the optical axis [m]. The depth buffer holds t, linear between near and far.
///
/// Where a ray enters a solid counts. A camera inside of a solid, or a near plane that cuts it, sees through it.
///
/// A program is kVersion, "#define SHAPE n" (Shape), "#define PICTURE n" (PictureKind), and one of the texts below.

namespace spark::camera {

inline constexpr char kVersion[] = "#version 330 core\n";

/// Attributes 4 to 15 are those of an Instance. kMeshShape is Shape::mesh.
inline constexpr char kVertexShader[] = R"(
const int kPlane = 4, kMesh = 5;
layout(location = 0) in vec3 position;     // of a solid: a corner of the cube from -1 to 1
layout(location = 4) in vec4 toCamera0;    // rows of the matrix from the local frame to the camera's
layout(location = 5) in vec4 toCamera1;
layout(location = 6) in vec4 toCamera2;
layout(location = 7) in vec4 toLocal0;     // rows of its inverse
layout(location = 8) in vec4 toLocal1;
layout(location = 9) in vec4 toLocal2;
layout(location = 10) in vec4 size;        // half the box around it; radius
layout(location = 11) in vec4 ambient;
layout(location = 12) in vec4 diffuse;
layout(location = 13) in vec4 specular;
layout(location = 14) in vec4 emission;
layout(location = 15) in vec2 finish;      // shininess, number in segmentations
#if SHAPE == 5
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 place;
layout(location = 3) in vec3 faceNormal;
smooth out vec3 meshNormal;
smooth out vec2 meshPlace;
flat out vec4 face;                        // normal and distance of the triangle's plane
#else
flat out vec4 local0, local1, local2, extent;
#endif
flat out vec4 matAmbient, matDiffuse, matSpecular, matEmission;
flat out vec2 matFinish;
uniform vec2 slope;                        // tangents of half the field of view, horizontal and vertical
uniform float pixel;                       // size of a pixel at 1 m

vec3 fromLocal(vec3 v) {                   // a normal, from the local frame to the camera's
  return v.x * toLocal0.xyz + v.y * toLocal1.xyz + v.z * toLocal2.xyz;
}

void main() {
  matAmbient = ambient, matDiffuse = diffuse, matSpecular = specular, matEmission = emission, matFinish = finish;
#if SHAPE == 5
  vec4 p = vec4(position, 1);
  vec3 c = vec3(dot(toCamera0, p), dot(toCamera1, p), dot(toCamera2, p));
  meshNormal = fromLocal(normal);
  meshPlace = place;
  vec3 n = normalize(fromLocal(faceNormal));
  face = vec4(n, dot(n, c));
#else
  local0 = toLocal0, local1 = toLocal1, local2 = toLocal2, extent = size;
#if SHAPE == 4
  gl_Position = vec4(position.xy, 0.5 * position.z, 1);
  return;
#endif
  // A corner of the box, and a small part of a pixel outwards, against rounding.
  vec3 x = position.x * size.x * vec3(toCamera0.x, toCamera1.x, toCamera2.x);
  vec3 y = position.y * size.y * vec3(toCamera0.y, toCamera1.y, toCamera2.y);
  vec3 z = position.z * size.z * vec3(toCamera0.z, toCamera1.z, toCamera2.z);
  vec3 c = vec3(toCamera0.w, toCamera1.w, toCamera2.w) + x + y + z;
  c += (0.0001 + 0.05 * pixel * abs(c.y)) * (normalize(x) + normalize(y) + normalize(z));
#endif
  gl_Position = vec4(c.x / slope.x, c.z / slope.y, c.y - 0.002, c.y);
}
)";

inline constexpr char kFragmentShader[] = R"(
#if SHAPE == 5
smooth in vec3 meshNormal;
smooth in vec2 meshPlace;
flat in vec4 face;
#else
flat in vec4 local0, local1, local2, extent;
#endif
flat in vec4 matAmbient, matDiffuse, matSpecular, matEmission;
flat in vec2 matFinish;
uniform vec2 slope, viewport, range;       // range: zNear, zFar
#if PICTURE == 0
const int kLights = 8;
uniform int lights;
uniform vec3 ambientLight, lightPlace[kLights], lightDiffuse[kLights], lightSpecular[kLights];
uniform bool textured;
uniform sampler2D image;
out vec4 pixelColour;
#else
out uint pixelNumber;
#endif

const float kMiss = -1;

// Where the ray enters the solid, its normal there and the place on its picture, all in the local frame.
#if SHAPE == 0
float enter(vec3 o, vec3 d, out vec3 normal, out vec2 place) {
  d = mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
  vec3 h = extent.xyz, a = (-h - o) / d, b = (h - o) / d, near = min(a, b), far = max(a, b);
  float t = max(max(near.x, near.y), near.z);
  if (t > min(min(far.x, far.y), far.z)) return kMiss;
  vec3 p = (o + t * d) / (2 * h) + 0.5;
  if (t == near.x) normal = vec3(-sign(d.x), 0, 0), place = vec2(d.x < 0 ? p.y : 1 - p.y, p.z);
  else if (t == near.y) normal = vec3(0, -sign(d.y), 0), place = vec2(d.y < 0 ? 1 - p.x : p.x, p.z);
  else normal = vec3(0, 0, -sign(d.z)), place = vec2(p.x, d.z < 0 ? p.y : 1 - p.y);
  return t;
}
#elif SHAPE == 1
float enter(vec3 o, vec3 d, out vec3 normal, out vec2 place) {
  float dd = dot(d, d), middle = -dot(o, d) / dd;
  vec3 p = o + middle * d;
  float q = (1 - dot(p, p)) / dd;
  if (q < 0) return kMiss;
  normal = p - sqrt(q) * d;
  place = vec2(atan(normal.y, normal.x) / 6.2831853 + 0.5, asin(clamp(normal.z, -1, 1)) / 3.1415927 + 0.5);
  return middle - sqrt(q);
}
#elif SHAPE == 2
float enter(vec3 o, vec3 d, out vec3 normal, out vec2 place) {
  // The ray is inside of the infinite cylinder around middle +- reach, and between the ends from `top` on.
  float dd = max(dot(d.xy, d.xy), 1e-20), middle = -dot(o.xy, d.xy) / dd;
  vec2 p = o.xy + middle * d.xy;
  float q = (extent.w * extent.w - dot(p, p)) / dd;
  if (q < 0) return kMiss;
  float dz = abs(d.z) < 1e-20 ? 1e-20 : d.z, side = middle - sqrt(q);
  float top = (-sign(dz) * extent.z - o.z) / dz, bottom = (sign(dz) * extent.z - o.z) / dz;
  if (max(side, top) > min(middle + sqrt(q), bottom)) return kMiss;
  if (side > top) {
    normal = vec3(p - sqrt(q) * d.xy, 0);
    place = vec2(atan(normal.y, normal.x) / 6.2831853 + 0.5, (o.z + side * d.z) / (2 * extent.z) + 0.5);
    return side;
  }
  normal = vec3(0, 0, -sign(dz));
  place = (o.xy + top * d.xy) / (2 * extent.w) + 0.5;
  return top;
}
#elif SHAPE == 3
float enter(vec3 o, vec3 d, out vec3 normal, out vec2 place) {
  // The infinite cylinder first: where the ray enters it beyond an end, only the half sphere of that end can be hit.
  float r = extent.w, half_ = extent.z - r, dd = max(dot(d.xy, d.xy), 1e-20), middle = -dot(o.xy, d.xy) / dd;
  vec2 p = o.xy + middle * d.xy;
  float q = (r * r - dot(p, p)) / dd;
  if (q < 0) return kMiss;
  float t = middle - sqrt(q), z = o.z + t * d.z;
  normal = vec3(p - sqrt(q) * d.xy, 0);
  if (abs(z) > half_) {
    vec3 end = vec3(0, 0, sign(z) * half_), from = o - end;
    dd = dot(d, d), middle = -dot(from, d) / dd;
    vec3 s = from + middle * d;
    q = (r * r - dot(s, s)) / dd;
    if (q < 0) return kMiss;
    t = middle - sqrt(q);
    normal = s - sqrt(q) * d;
  }
  place = vec2(atan(normal.y, normal.x) / 6.2831853 + 0.5, (o.z + t * d.z) / (2 * extent.z) + 0.5);
  return t;
}
#elif SHAPE == 4
float enter(vec3 o, vec3 d, out vec3 normal, out vec2 place) {
  if (d.z >= 0) return kMiss;
  float t = -o.z / d.z;
  normal = vec3(0, 0, 1);
  place = o.xy + t * d.xy;
  return t;
}
#endif

#if PICTURE == 0
vec4 colour(vec3 p, vec3 n, vec4 image) {
  vec3 sum = matEmission.rgb + ambientLight * matAmbient.rgb, shine = vec3(0);
  for (int i = 0; i < lights; ++i) {
    vec3 l = normalize(lightPlace[i] - p);
    float facing = dot(n, l);
    if (facing <= 0) continue;
    sum += facing * lightDiffuse[i] * matDiffuse.rgb;
    float mirrored = max(dot(n, normalize(l - normalize(p))), 1e-6);
    shine += pow(mirrored, matFinish.x) * lightSpecular[i] * matSpecular.rgb;
  }
  return vec4(sum * image.rgb + shine, matDiffuse.a * image.a);
}
#endif

void main() {
  vec2 at = 2 * gl_FragCoord.xy / viewport - 1;
  vec3 ray = vec3(at.x * slope.x, 1, at.y * slope.y);
#if SHAPE == 5
  float along = dot(face.xyz, ray), t = abs(along) > 1e-4 ? face.w / along : 1 / gl_FragCoord.w;
#else
  // From the camera to the solid first, so that what follows computes with numbers of its size.
  vec3 eye = vec3(local0.w, local1.w, local2.w);
  vec3 d = vec3(dot(local0.xyz, ray), dot(local1.xyz, ray), dot(local2.xyz, ray)), normal;
  vec2 place;
#if SHAPE == 4
  float t = enter(eye, d, normal, place);
#else
  float shift = -dot(eye, d) / dot(d, d), t = enter(eye + shift * d, d, normal, place);
  t = t == kMiss ? kMiss : t + shift;
#endif
#endif
#if PICTURE == 0
#if SHAPE == 5
  vec4 texel = textured ? texture(image, meshPlace) : vec4(1);
#endif
#endif
  if (!(t >= range.x && t <= range.y)) discard;
  gl_FragDepth = (t - range.x) / (range.y - range.x);
#if PICTURE == 0
#if SHAPE == 5
  vec3 n = normalize(meshNormal);
  if (dot(face.xyz, ray) > 0) n = -n;      // the back of a face looks like its front
#else
  vec3 n = normalize(normal.x * local0.xyz + normal.y * local1.xyz + normal.z * local2.xyz);
  vec4 texel = textured ? textureLod(image, place, 0) : vec4(1);
#endif
  pixelColour = colour(t * ray, n, texel);
#elif PICTURE == 1
  pixelNumber = uint(min(1000 * t + 0.5, 65535));
#else
  pixelNumber = uint(matFinish.y);
#endif
}
)";

}  // namespace spark::camera
