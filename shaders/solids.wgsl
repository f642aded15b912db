// Bars, joints and base: instanced meshes with diffuse lighting. A horizontal face seen from straight above has exactly
// its own colour.

struct Frame {
    clip_from_world: mat4x4<f32>,
    eye_direction: vec3<f32>,
    pixels_per_point: f32,
    size_px: vec2<f32>,
    background: vec4<f32>,
};

struct Instance {
    world_from_mesh: mat4x4<f32>,
    colour: vec4<f32>,
};

struct Vertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
};

struct Varying {
    // Invariant: both passes over translucent solids must compute identical depths.
    @builtin(position) @invariant clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) @interpolate(flat) colour: vec4<f32>,
};

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read> instances: array<Instance>;

// The cofactor matrix transforms normals correctly under any scaling.
fn cofactors(m: mat4x4<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(cross(m[1].xyz, m[2].xyz), cross(m[2].xyz, m[0].xyz), cross(m[0].xyz, m[1].xyz));
}

@vertex
fn vertex(v: Vertex, @builtin(instance_index) i: u32) -> Varying {
    let m = instances[i].world_from_mesh;
    var out: Varying;
    out.clip = frame.clip_from_world * (m * vec4<f32>(v.position, 1.0));
    out.normal = cofactors(m) * v.normal;
    out.colour = instances[i].colour;
    return out;
}

const KEY = vec3<f32>(-0.36, 0.48, 0.8); // towards the light: above left, unit

// Sky light from above, a key light, and a faint light at the eye.
fn light(normal: vec3<f32>, eye: vec3<f32>) -> f32 {
    let sky = mix(0.46, 0.62, 0.5 + 0.5 * normal.z);
    let key = 0.30 * max(dot(normal, KEY), 0.0);
    let lamp = 0.14 * max(dot(normal, eye), 0.0);
    return sky + key + lamp;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let up = vec3<f32>(0.0, 0.0, 1.0);
    let level = light(normalize(in.normal), frame.eye_direction) / light(up, up);
    // Levels above 1 are blended towards white instead of clipped.
    let lit = mix(in.colour.rgb * min(level, 1.0), vec3<f32>(1.0), clamp(level - 1.0, 0.0, 1.0));
    return vec4<f32>(lit, in.colour.a);
}

// An open surface: lit on the visible side, and more opaque at grazing angles, like glass.
@fragment
fn shell_fragment(in: Varying) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    let facing = dot(normal, frame.eye_direction);
    let level = light(select(-normal, normal, facing >= 0.0), frame.eye_direction) / light(KEY, KEY);
    let rim = 1.0 - abs(facing);
    let alpha = in.colour.a * (1.0 + 1.2 * rim * rim * rim);
    return vec4<f32>(in.colour.rgb * mix(level, 1.0, 0.4), min(alpha, 1.0));
}

const CASING = 1.25; // px

// The back faces of the solid, a little wider on the screen; the visible rim separates the solid from those below it.
@vertex
fn casing_vertex(v: Vertex, @builtin(instance_index) i: u32) -> @builtin(position) vec4<f32> {
    let m = instances[i].world_from_mesh;
    var clip = frame.clip_from_world * (m * vec4<f32>(v.position, 1.0));
    let normal = frame.clip_from_world * vec4<f32>(cofactors(m) * v.normal, 0.0);
    // Direction in which the point moves on the screen when it moves along its normal.
    let out = (normal.xy * clip.w - clip.xy * normal.w) * frame.size_px;
    if length(out) > 1e-12 {
        let shift = normalize(out) * CASING * frame.pixels_per_point;
        clip += vec4<f32>(2.0 * shift / frame.size_px * clip.w, 0.0, 0.0);
    }
    return clip;
}

@fragment
fn casing_fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(frame.background.rgb * frame.background.a, frame.background.a);
}
