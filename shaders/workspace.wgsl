// A reactionless workspace, Eq. (16), evaluated at each vertex of a grid over (a_1, a_2). The rotation b* is one number
// of the area, so rotating it needs no new geometry. Overlapping sheets blend to a stronger colour. A measure of
// dexterity, which does not depend on b*, interpolates between two colours.

struct Frame {
    clip_from_world: mat4x4<f32>,
    eye_direction: vec3<f32>,
    pixels_per_point: f32,
    size_px: vec2<f32>,
    background: vec4<f32>,
};

struct Area {
    world_from_plane: mat4x4<f32>,
    c: vec3<f32>,   // c_k, m
    turn: f32,      // b*, rad
    u1: vec3<f32>,  // first component of u_k
    z: f32,         // m
    u2: vec3<f32>,  // second component of u_k
    x: f32,         // x of B, m
    v: vec3<f32>,   // v_k, rad
    y: f32,         // y of B, m
    a_min: vec2<f32>,
    a_max: vec2<f32>,
    colour: vec4<f32>, // where |share| is 0
    shade: vec4<f32>,  // where |share| is 1 or more
    full: f32,
    empty: f32,
    measure: u32,      // 0: |det|, m^2; 1: sqrt det(J J^T), m^2; 2: worst |tau| of a unit force, N m/N
};

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) colour: vec4<f32>,
    @location(1) @interpolate(flat) shade: vec4<f32>,
    @location(2) share: f32, // (measure - empty) / (full - empty); for det its sign differs between sheets
};

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read> areas: array<Area>;

override CELLS: u32 = 64u; // per side; the index buffer depends on it

@vertex
fn vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) i: u32) -> Varying {
    let area = areas[i];
    let cell = vec2<f32>(f32(vertex % (CELLS + 1u)), f32(vertex / (CELLS + 1u))) / f32(CELLS);
    let a = mix(area.a_min, area.a_max, cell);
    let angle = area.u1 * a.x + area.u2 * a.y + area.v + area.turn;
    let x = area.c * cos(angle);
    let y = area.c * sin(angle);
    let one = vec3<f32>(1.0);
    let at = vec3<f32>(area.x + dot(x, one), area.y + dot(y, one), area.z);
    // d(x + iy)/da_j = i sum_k u_kj (x_k + i y_k); a quarter turn of both columns does not change det.
    var value = dot(x, area.u1) * dot(y, area.u2) - dot(y, area.u1) * dot(x, area.u2);
    if area.measure == 1u {
        let minors = x * y.yzx - y * x.yzx;
        value = length(minors);
    } else if area.measure == 2u {
        let squares = vec2<f32>(dot(x, x) - dot(y, y), 2.0 * dot(x, y));
        value = sqrt(0.5 * (dot(x, x) + dot(y, y) + length(squares)));
    }
    var out: Varying;
    out.clip = frame.clip_from_world * (area.world_from_plane * vec4<f32>(at, 1.0));
    out.colour = area.colour;
    out.shade = area.shade;
    out.share = (value - area.empty) / (area.full - area.empty);
    return out;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    return mix(in.colour, in.shade, clamp(abs(in.share), 0.0, 1.0));
}
