// Soft shadows of bars on the plane below them: fully dark up to `core` from the centre line, zero from `reach` on.

struct Frame {
    clip_from_world: mat4x4<f32>,
    eye_direction: vec3<f32>,
    pixels_per_point: f32,
    size_px: vec2<f32>,
    background: vec4<f32>,
};

struct Shadow {
    root: vec2<f32>, // m
    tip: vec2<f32>,  // m
    z: f32,          // height of the plane, m
    core: f32,       // half width of the fully dark part, m
    reach: f32,      // half width of the whole shadow, m
    strength: f32,
};

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec2<f32>,
    @location(1) @interpolate(flat) ends: vec4<f32>,
    @location(2) @interpolate(flat) shade: vec3<f32>, // core, reach, strength
};

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read> shadows: array<Shadow>;

@vertex
fn vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) i: u32) -> Varying {
    let s = shadows[i];
    let way = s.tip - s.root;
    let size = length(way);
    let along = select(vec2<f32>(1.0, 0.0), way / size, size > 1e-9);
    let across = vec2<f32>(-along.y, along.x);
    let far = (corner & 1u) == 1u;
    let side = select(-s.reach, s.reach, (corner & 2u) == 2u);
    var out: Varying;
    out.at = select(s.root - along * s.reach, s.tip + along * s.reach, far) + across * side;
    out.clip = frame.clip_from_world * vec4<f32>(out.at, s.z, 1.0);
    out.ends = vec4<f32>(s.root, s.tip);
    out.shade = vec3<f32>(s.core, s.reach, s.strength);
    return out;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let way = in.ends.zw - in.ends.xy;
    let t = clamp(dot(in.at - in.ends.xy, way) / max(dot(way, way), 1e-12), 0.0, 1.0);
    let off = distance(in.at, in.ends.xy + t * way);
    return vec4<f32>(0.0, 0.0, 0.0, in.shade.z * (1.0 - smoothstep(in.shade.x, in.shade.y, off)));
}
