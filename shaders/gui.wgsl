// Triangles of the user interface (letters, lines and areas), each with a colour and texture coordinates.

struct Screen {
    // Width and height, logical points.
    size: vec2<f32>,
};

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
    // sRGB values with premultiplied alpha, like those of the texture.
    @location(1) colour: vec4<f32>,
};

@group(0) @binding(0) var<uniform> screen: Screen;
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var filtering: sampler;

@vertex
fn vertex(@location(0) at: vec2<f32>, @location(1) uv: vec2<f32>, @location(2) colour: vec4<f32>) -> Varying {
    let across = 2.0 * at / screen.size - 1.0;
    var out: Varying;
    out.clip = vec4<f32>(across.x, -across.y, 0.0, 1.0);
    out.uv = uv;
    out.colour = colour;
    return out;
}

// A target without sRGB encoding takes sRGB values unchanged.
@fragment
fn plain(in: Varying) -> @location(0) vec4<f32> {
    return in.colour * textureSample(image, filtering, in.uv);
}

// A target that encodes to sRGB on writing needs linear values.
@fragment
fn encoding(in: Varying) -> @location(0) vec4<f32> {
    let c = in.colour * textureSample(image, filtering, in.uv);
    let low = c.rgb / 12.92;
    let high = pow((c.rgb + 0.055) / 1.055, vec3<f32>(2.4));
    return vec4<f32>(select(high, low, c.rgb <= vec3<f32>(0.04045)), c.a);
}
