/** Filter of the red-light theme for photos, maps and pictures. */
export function RedLight() {
  return (
    <svg width="0" height="0" class="spoken" aria-hidden="true">
      <filter id="red-light" color-interpolation-filters="sRGB">
        <feColorMatrix values="1 0 0 0 0  0 0 0 0 0  0 0 0 0 0  0 0 0 1 0" />
      </filter>
    </svg>
  );
}
