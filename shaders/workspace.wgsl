// A reactionless workspace, Eq. (16), evaluated at each vertex of a grid over (a_1, a_2). The turn b* is one number of
// the area, so turning it costs nothing. Sheets that overlap blend, and the colour gathers.

struct Frame {
    clip_from_world: mat4x4<f32>,
    eye_direction: vec3<f32>,
    pixels_per_point: f32,
    size_px: vec2<f32>,
    background: vec4<f32>,
};

struct Area {
    c: vec3<f32>,   // c_k, m
    turn: f32,      // b*, rad
    u1: vec3<f32>,  // first component of u_k
    z: f32,         // m
    u2: vec3<f32>,  // second component of u_k
    v: vec3<f32>,   // v_k, rad
    a_min: vec2<f32>,
    a_max: vec2<f32>,
    colour: vec4<f32>,
};

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) colour: vec4<f32>,
};

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read> areas: array<Area>;

const CELLS = 64u; // a side; the index buffer counts on it

@vertex
fn vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) i: u32) -> Varying {
    let area = areas[i];
    let cell = vec2<f32>(f32(vertex % (CELLS + 1u)), f32(vertex / (CELLS + 1u))) / f32(CELLS);
    let a = mix(area.a_min, area.a_max, cell);
    let angle = area.u1 * a.x + area.u2 * a.y + area.v + area.turn;
    let at = vec3<f32>(dot(area.c, cos(angle)), dot(area.c, sin(angle)), area.z);
    var out: Varying;
    out.clip = frame.clip_from_world * vec4<f32>(at, 1.0);
    out.colour = area.colour;
    return out;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    return in.colour;
}
