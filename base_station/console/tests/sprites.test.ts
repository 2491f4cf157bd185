import { expect, it, vi } from "vitest";
import { Sprites, type Context, type Sheet } from "../src/plan/sprites";

function watched() {
  const make = vi.fn((width: number, height: number) => ({ width, height }) as Sheet);
  const drawImage = vi.fn();
  return { sprites: new Sprites(make), make, drawImage, page: { drawImage } as unknown as Context };
}

const paint = () => undefined;

it("makes each drawing once, and copies it", () => {
  const { sprites, make, drawImage, page } = watched();
  sprites.begin(1, "light");
  for (const key of ["a", "b", "a", "a"]) sprites.draw(page, key, [50, 50], [20, 10], paint);
  expect(make).toHaveBeenCalledTimes(2);
  expect(drawImage).toHaveBeenCalledTimes(4);
});

it("puts its middle to the place, at whole pixels of the screen", () => {
  const { sprites, drawImage, page } = watched();
  sprites.begin(2, "light");
  sprites.draw(page, "a", [50.2, 40.4], [20, 10], paint);
  expect(drawImage).toHaveBeenCalledWith({ width: 40, height: 20 }, 80, 71);
});

it("makes them anew for another theme or density", () => {
  const { sprites, make, page } = watched();
  for (const [ratio, theme] of [[1, "light"], [1, "dark"], [2, "dark"], [2, "dark"]] as const) {
    sprites.begin(ratio, theme);
    sprites.draw(page, "a", [0, 0], [20, 10], paint);
  }
  expect(make).toHaveBeenCalledTimes(3);
});

it("keeps no more than it may", () => {
  const { sprites, make, page } = watched();
  sprites.begin(1, "light");
  for (let i = 0; i < 2001; i++) sprites.draw(page, String(i), [0, 0], [20, 10], paint);
  sprites.draw(page, "2000", [0, 0], [20, 10], paint);
  sprites.draw(page, "0", [0, 0], [20, 10], paint);
  expect(make).toHaveBeenCalledTimes(2002);
});
