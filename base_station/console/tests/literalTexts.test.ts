/** No text for a person stands outside the catalogues. */
import { parseSync } from "vite";
import { expect, it } from "vitest";

const SOURCES = import.meta.glob<string>(["../src/**/*.{ts,tsx}", "!../src/language/{en,de,fr}/*"], {
  query: "?raw",
  import: "default",
  eager: true,
});
/** Attributes whose value is shown or read aloud. */
const SPOKEN = new Set([
  "about",
  "alt",
  "aria-label",
  "data-label",
  "label",
  "legend",
  "placeholder",
  "question",
  "title",
  "what",
  "word",
  "yes",
]);
/** Names, commands and marks that are the same in every language. */
const SAME_EVERYWHERE = new Set(["Muster", "muster edge run --enrolment", "muster edge enrol PHOTO", "HTML", "PDF"]);
const WORD = /\p{L}{2}/u;
/** A sentence, or a label of several words: it begins with a capital letter. */
const SENTENCE = /^\p{Lu}\S* .*\p{Ll}{2}/u;

interface Node {
  type: string;
  [field: string]: unknown;
}

function isNode(value: unknown): value is Node {
  return typeof value === "object" && value !== null && typeof (value as Node).type === "string";
}

function children(node: Node): Node[] {
  return Object.values(node).flatMap((value) => (Array.isArray(value) ? value : [value])).filter(isNode);
}

/** The text of a string or a template without its values; undefined: it is none. */
function textOf(node: Node): string | undefined {
  if (node.type === "Literal") return typeof node["value"] === "string" ? node["value"] : undefined;
  if (node.type !== "TemplateLiteral") return undefined;
  const quasis = node["quasis"] as readonly { value: { cooked: string } }[];
  return quasis.map(({ value }) => value.cooked).join("…");
}

/** Strings that an expression may become: of "a ? b : c" both. */
function outcomes(node: Node): string[] {
  const text = textOf(node);
  if (text !== undefined) return [text];
  if (node.type === "JSXExpressionContainer") return outcomes(node["expression"] as Node);
  if (node.type === "ConditionalExpression") {
    return [...outcomes(node["consequent"] as Node), ...outcomes(node["alternate"] as Node)];
  }
  return node.type === "LogicalExpression" ? outcomes(node["right"] as Node) : [];
}

function literals(node: Node): string[] {
  const deeper = () => children(node).flatMap(literals);
  switch (node.type) {
    case "ImportDeclaration":
    case "TSLiteralType":
      return [];
    case "JSXText":
      return [String(node["value"])].filter(isWord);
    case "JSXElement":
    case "JSXFragment":
      return [...(node["children"] as Node[]).flatMap(outcomes).filter(isWord), ...deeper()];
    case "JSXAttribute": {
      const name = (node["name"] as Node)["name"] as string;
      const value = node["value"];
      if (!isNode(value)) return [];
      return SPOKEN.has(name) ? [...outcomes(value).filter(isWord), ...deeper()] : deeper();
    }
    default: {
      const text = textOf(node);
      return [...(text !== undefined && SENTENCE.test(text) ? [text] : []), ...deeper()];
    }
  }
}

function isWord(text: string): boolean {
  return WORD.test(text.replaceAll("…", "")) && !SAME_EVERYWHERE.has(text.trim());
}

function literalsOf(path: string, source: string): string[] {
  const { program, errors } = parseSync(path, source);
  expect(errors, path).toEqual([]);
  return [...new Set(literals(program as unknown as Node).map((text) => text.trim()))];
}

const FILES = Object.entries(SOURCES).map(([path, source]) => [path.replace("../src/", ""), source] as const);

it("finds texts where a person would see them", () => {
  const seen = literalsOf(
    "Example.tsx",
    'const a = <p title="Close it" class="wide row">Text {on ? "Yes" : `No ${x}`} {t("common.no")}</p>; say("Nothing was sent");',
  );
  expect(seen.sort()).toEqual(["Close it", "No …", "Nothing was sent", "Text", "Yes"]);
});

it("finds none in the source", () => {
  expect(FILES.length).toBeGreaterThan(100);
  const found = FILES.map(([path, source]) => [path, literalsOf(path, source)] as const);
  expect(Object.fromEntries(found.filter(([, texts]) => texts.length > 0))).toEqual({});
});
