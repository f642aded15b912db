// Polylines as ribbons of constant width on the screen. Each segment is drawn as the bounding rectangle of a capsule.
// The fragment shader computes the distance to the segment, so joins and ends are round and edges are antialiased.
// Fragments near a joint belong to one of its two segments only, so translucent lines are not darker at joints.

struct Frame {
    clip_from_world: mat4x4<f32>,
    eye_direction: vec3<f32>,
    pixels_per_point: f32,
    size_px: vec2<f32>,
    background: vec4<f32>,
};

struct Segment {
    a: vec3<f32>,
    width: f32,  // px
    b: vec3<f32>,
    arc: f32,    // physical px from the line's start to a
    before: vec3<f32>, // the vertex before a; a itself where the line starts
    dash: f32,   // px; 0 for a solid line
    after: vec3<f32>,  // the vertex after b; b itself where the line ends
    gap: f32,    // px
    colour: vec4<f32>,
};

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) ends: vec4<f32>, // a, b on the screen
    @location(1) @interpolate(flat) cuts: vec4<f32>, // normals of the borders with the neighbours; zero without one
    @location(2) @interpolate(flat) shape: vec4<f32>, // half width, arc, dash, gap, all in physical px
    @location(3) @interpolate(flat) colour: vec4<f32>,
};

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<storage, read> segments: array<Segment>;

// Shift towards the eye as a fraction of the depth range, so that a line on a face is drawn over the face.
const BIAS = 1e-5;

fn screen(clip: vec4<f32>) -> vec2<f32> {
    return (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * frame.size_px;
}

fn unit(v: vec2<f32>) -> vec2<f32> {
    let l = length(v);
    return select(vec2<f32>(0.0), v / max(l, 1e-20), l > 1e-6);
}

// A place or direction rounded to a grid. An adapter may round the same place differently for the two segments that meet
// there; on the grid both are equal, and near a joint the products below are exact.
fn on_grid(p: vec2<f32>, per_unit: f32) -> vec2<f32> {
    return round(p * per_unit) / per_unit;
}

const GRID = 256.0; // per px

// Unit normal of the line through joint j that bisects the angle between p-j and j-n, on a grid; zero if it is undefined.
// Both segments that meet in j call this with the same arguments, so their results are identical.
fn border(p: vec2<f32>, j: vec2<f32>, n: vec2<f32>) -> vec2<f32> {
    let u = unit(j - p);
    let v = unit(n - j);
    let both = any(u != vec2<f32>(0.0)) && any(v != vec2<f32>(0.0));
    return select(vec2<f32>(0.0), on_grid(unit(u + v), 1024.0), both);
}

@vertex
fn vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) i: u32) -> Varying {
    let s = segments[i];
    var a = frame.clip_from_world * vec4<f32>(s.a, 1.0);
    var b = frame.clip_from_world * vec4<f32>(s.b, 1.0);
    let before = frame.clip_from_world * vec4<f32>(s.before, 1.0);
    let after = frame.clip_from_world * vec4<f32>(s.after, 1.0);

    var out: Varying;
    if a.z < 0.0 && b.z < 0.0 {
        out.clip = vec4<f32>(0.0, 0.0, -1.0, 1.0); // all four corners coincide: nothing is drawn
        return out;
    }
    // Clip at the near plane: points behind the eye would be projected to the wrong side.
    let a_near = a.z < 0.0;
    let b_near = b.z < 0.0;
    let whole_a = a;
    if a_near { a = mix(a, b, a.z / (a.z - b.z)); }
    if b_near { b = mix(b, whole_a, b.z / (b.z - whole_a.z)); }

    let pa = screen(a);
    let pb = screen(b);
    var cuts = vec4<f32>(0.0);
    // Where a line starts or ends, the vertices themselves are equal; their places on the screen need not be.
    if !a_near && before.z >= 0.0 && any(s.before != s.a) { cuts = vec4<f32>(border(screen(before), pa, pb), cuts.zw); }
    if !b_near && after.z >= 0.0 && any(s.after != s.b) { cuts = vec4<f32>(cuts.xy, border(pa, pb, screen(after))); }

    let half = 0.5 * s.width * frame.pixels_per_point;
    let reach = max(half, 0.5) + 1.0; // margin for the antialiased edge
    var along = unit(pb - pa);
    if all(along == vec2<f32>(0.0)) { along = vec2<f32>(1.0, 0.0); }
    let across = vec2<f32>(-along.y, along.x);
    let at_b = (corner & 1u) == 1u;
    let left = (corner & 2u) == 2u;
    let p = select(pa - along * reach, pb + along * reach, at_b) + across * select(-reach, reach, left);
    let w = select(a.w, b.w, at_b);
    let z = select(a.z, b.z, at_b);
    let ndc = (p / frame.size_px - 0.5) * vec2<f32>(2.0, -2.0);
    out.clip = vec4<f32>(ndc * w, max(z - BIAS * w, 0.0), w);
    out.ends = vec4<f32>(pa, pb);
    out.cuts = cuts;
    out.shape = vec4<f32>(half, s.arc, s.dash * frame.pixels_per_point, s.gap * frame.pixels_per_point);
    out.colour = s.colour;
    return out;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let p = in.clip.xy;
    let a = in.ends.xy;
    let b = in.ends.zw;
    let beyond_a = dot(p - on_grid(a, GRID), in.cuts.xy) < 0.0;
    if beyond_a || (any(in.cuts.zw != vec2<f32>(0.0)) && dot(p - on_grid(b, GRID), in.cuts.zw) >= 0.0) {
        discard;
    }
    let half = in.shape.x;
    let wide = max(half, 0.5); // a line thinner than a pixel is drawn a pixel wide and fainter
    let ab = b - a;
    let along = dot(p - a, ab) / max(length(ab), 1e-6);
    let on = clamp(along, 0.0, length(ab));
    let away = distance(p, a + ab * (on / max(length(ab), 1e-6)));
    var cover = clamp(wide + 0.5 - away, 0.0, 1.0);

    let dash = in.shape.z;
    let gap = in.shape.w;
    if dash > 0.0 && gap > 0.0 {
        // Distance to the nearest dash, a rounded rectangle of length `dash`; dash = width gives dots.
        let period = dash + gap;
        let s = in.shape.y + on - 0.5 * dash;
        let t = abs(s - period * round(s / period));
        let r = min(wide, 0.5 * dash);
        let q = vec2<f32>(t - 0.5 * dash, away - wide) + r;
        let d = min(max(q.x, q.y), 0.0) + length(max(q, vec2<f32>(0.0))) - r;
        cover = min(cover, clamp(0.5 - d, 0.0, 1.0));
    }
    return vec4<f32>(in.colour.rgb, in.colour.a * cover * min(2.0 * half, 1.0));
}
