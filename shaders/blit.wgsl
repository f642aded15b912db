// Copies the finished picture to another target, pixel for pixel.

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
};

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var nearest: sampler;

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    // One triangle that covers the viewport.
    let uv = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    var out: Varying;
    out.clip = vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0);
    out.uv = uv;
    return out;
}

// The picture holds sRGB values; a target without sRGB encoding takes them unchanged.
@fragment
fn plain(in: Varying) -> @location(0) vec4<f32> {
    return textureSample(picture, nearest, in.uv);
}

// A target that encodes to sRGB on writing needs linear values.
@fragment
fn encoding(in: Varying) -> @location(0) vec4<f32> {
    let c = textureSample(picture, nearest, in.uv);
    let low = c.rgb / 12.92;
    let high = pow((c.rgb + 0.055) / 1.055, vec3<f32>(2.4));
    return vec4<f32>(select(high, low, c.rgb <= vec3<f32>(0.04045)), c.a);
}
