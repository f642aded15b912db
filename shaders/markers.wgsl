// Discs and rings of constant size on the screen, over everything. Output colours have premultiplied alpha.

struct Frame {
    clip_from_world: mat4x4<f32>,
    eye_direction: vec3<f32>,
    pixels_per_point: f32,
    size_px: vec2<f32>,
    background: vec4<f32>,
};

struct Marker {
    at: vec3<f32>,
    radius: f32,       // px, outer
    fill: vec4<f32>,
    stroke: vec4<f32>,
    stroke_width: f32, // px
};

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) disc: vec4<f32>, // centre, outer and inner radius, physical px
    @location(1) @interpolate(flat) fill: vec4<f32>,
    @location(2) @interpolate(flat) stroke: vec4<f32>,
};

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read> markers: array<Marker>;

@vertex
fn vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) i: u32) -> Varying {
    let m = markers[i];
    let centre = frame.clip_from_world * vec4<f32>(m.at, 1.0);
    var out: Varying;
    if centre.z < 0.0 {
        out.clip = vec4<f32>(0.0, 0.0, -1.0, 1.0); // behind the eye: all corners coincide
        return out;
    }
    let p = (centre.xy / centre.w * vec2<f32>(0.5, -0.5) + 0.5) * frame.size_px;
    let outer = m.radius * frame.pixels_per_point;
    let side = vec2<f32>(select(-1.0, 1.0, (corner & 1u) == 1u), select(-1.0, 1.0, (corner & 2u) == 2u));
    let ndc = ((p + side * (outer + 1.0)) / frame.size_px - 0.5) * vec2<f32>(2.0, -2.0);
    out.clip = vec4<f32>(ndc, 0.0, 1.0);
    out.disc = vec4<f32>(p, outer, outer - m.stroke_width * frame.pixels_per_point);
    out.fill = m.fill;
    out.stroke = m.stroke;
    return out;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let away = distance(in.clip.xy, in.disc.xy);
    let whole = clamp(in.disc.z + 0.5 - away, 0.0, 1.0);
    let inside = select(0.0, clamp(in.disc.w + 0.5 - away, 0.0, 1.0), in.disc.w > 0.0);
    let fill = vec4<f32>(in.fill.rgb, 1.0) * (in.fill.a * inside);
    let stroke = vec4<f32>(in.stroke.rgb, 1.0) * (in.stroke.a * (whole - inside));
    return fill + stroke;
}
