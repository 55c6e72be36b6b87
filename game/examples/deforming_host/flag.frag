// SPDX-License-Identifier: MIT
#version 460
layout(push_constant) uniform Push { layout(offset = 32) vec4 sizePx; } push;
layout(location = 0) in vec4 vClips[4];
layout(location = 4) in vec2 vPlace;
layout(location = 0) out vec4 outColor;
layout(location = 1) out vec2 outVector; // to the previous frame, in texture coordinates
layout(location = 2) out uint outEntityId;
layout(location = 3) out vec4 outDeformed; // pixels from here to shutter open and to close

vec2 placeOf(vec4 clip) { return (0.5f * clip.xy / clip.w + 0.5f) * push.sizePx.xy; }

void main() {
    bool isFlag = vClips[0].w < 6.0f;
    vec2 check = floor(vPlace * (isFlag ? vec2(12.0f, 4.0f) : vec2(40.0f)));
    bool isLight = mod(check.x + check.y, 2.0f) > 0.5f;
    vec3 flag = isLight ? vec3(0.9f) : vec3(0.8f, 0.1f, 0.1f);
    vec3 wall = isLight ? vec3(0.5f, 0.5f, 0.45f) : vec3(0.2f, 0.25f, 0.4f);
    outColor = vec4(isFlag ? flag : wall, 1.0f);
    vec2 open = placeOf(vClips[1]);
    vec2 close = placeOf(vClips[2]);
    outVector = (placeOf(vClips[3]) - placeOf(vClips[0])) / push.sizePx.xy;
    outEntityId = isFlag ? 1u : 0u;
    outDeformed = vec4(open, close) - placeOf(vClips[0]).xyxy;
}
