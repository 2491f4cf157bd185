/** The names of the placeholders of an ICU message, as types: "{count, plural, one {# of {all}} other {…}}" has
 * `count` and `all`. */
export type Placeholders<M extends string> = Within<M>[0];

/** Up to the brace that closes it, or its end: its names, and the text behind it. */
type Within<M extends string, Names = never> = M extends `${infer Before}{${infer After}`
  ? Before extends `${string}}${string}`
    ? Closed<M, Names>
    : Argument<After> extends [infer Name, infer Rest extends string]
      ? Within<Rest, Names | Name>
      : never
  : Closed<M, Names>;

type Closed<M extends string, Names> = M extends `${string}}${infer Rest}` ? [Names, Rest] : [Names, ""];

/** Behind its opening brace. */
type Argument<M extends string> = M extends `${infer Head}}${infer Rest}`
  ? Head extends `${infer Name},${string}`
    ? Head extends `${string}{${string}`
      ? M extends `${string},${string},${infer Choices}`
        ? Choice<Choices, Name>
        : never
      : [Name, Rest]
    : [Head, Rest]
  : never;

/** What a plural or select has for each case. */
type Choice<M extends string, Names> = M extends `${infer Before}{${infer After}`
  ? Before extends `${string}}${string}`
    ? Closed<M, Names>
    : Within<After> extends [infer More, infer Rest extends string]
      ? Choice<Rest, Names | More>
      : never
  : Closed<M, Names>;
