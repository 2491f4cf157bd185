import { PAGE } from "../http";
import { number } from "../language/measures";
import { t } from "../language/translate";

interface Props {
  first: number; // of the rows that are shown, from 0
  total: number;
  turn(first: number): void;
}

/** Leads through a list of which a part is shown. */
export function Turner({ first, total, turn }: Props) {
  const last = Math.min(first + PAGE, total);
  return (
    <>
      <button disabled={first === 0} onClick={() => turn(first - PAGE)}>
        {t("department.before")}
      </button>
      <span role="status">
        {t("department.shown", { first: number(Math.min(first + 1, total)), last: number(last), total: number(total) })}
      </span>
      <button disabled={last >= total} onClick={() => turn(first + PAGE)}>
        {t("department.after")}
      </button>
    </>
  );
}
