// Linear light to what a screen can show. src/inspect/for_tests/tone.rs has the same functions.

const TONE_CURVE_NEUTRAL: u32 = 0u;
const TONE_CURVE_NONE: u32 = 1u;

// Below this, colours are shown as they are, and above they are compressed.
const COMPRESSION_START: f32 = 0.76;

// How fast compressed colours become white.
const DESATURATION: f32 = 0.15;

// The Khronos PBR Neutral tone mapper (Khronos 2024, specification 1.0). Takes and returns linear RGB, which isn't negative.
fn neutral_tone(color: vec3<f32>) -> vec3<f32> {
    let least = min(color.x, min(color.y, color.z));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let shifted = color - vec3<f32>(offset);
    let peak = max(shifted.x, max(shifted.y, shifted.z));
    if peak < COMPRESSION_START {
        return shifted;
    }
    let room = 1.0 - COMPRESSION_START;
    let compressed = 1.0 - room * room / (peak + room - COMPRESSION_START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    return mix(shifted * (compressed / peak), vec3<f32>(compressed), white);
}

// Linear RGB to show, by the curve of that number; 0 to 1 under the neutral one.
fn tone_mapped(color: vec3<f32>, curve: u32) -> vec3<f32> {
    let light = max(color, vec3<f32>(0.0));
    return select(light, neutral_tone(light), curve == TONE_CURVE_NEUTRAL);
}
