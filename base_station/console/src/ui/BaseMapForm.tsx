import { useSignal } from "@preact/signals";
import { removeBaseMap, setBaseMap } from "../api";
import { ApiError } from "../http";
import { baseMap, crsOf, worldOf } from "../plan/baseMap";
import { attempt, user } from "../sessions";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";
import { useDone } from "./Done";

/** A picture of the ground with its world file; both stay on the station. */
export function BaseMapForm() {
  const image = useSignal<File | null>(null);
  const world = useSignal<File | null>(null);
  const epsg = useSignal("");
  const done = useDone(t("base_map.done"));
  if (user.value?.role !== "administrator") {
    return <p class="quiet">{t(baseMap.value === null ? "base_map.none" : "base_map.some")}</p>;
  }
  const send = async () => {
    if (image.value === null || world.value === null) return;
    const numbers = worldOf(await world.value.text());
    if (numbers === null) throw new ApiError(t("base_map.not_world_file"), 0);
    baseMap.value = await setBaseMap(image.value, numbers, crsOf(epsg.value, numbers));
    done.say();
  };
  return (
    <div class="row" onChange={done.unsay}>
      <label>
        {t("base_map.picture")}
        <input
          type="file"
          accept="image/png,image/jpeg,image/webp"
          onChange={(event) => (image.value = event.currentTarget.files?.[0] ?? null)}
        />
      </label>
      <label>
        {t("base_map.world_file")}
        <input
          type="file"
          accept=".pgw,.jgw,.tfw,.wld,text/plain"
          onChange={(event) => (world.value = event.currentTarget.files?.[0] ?? null)}
        />
      </label>
      <label>
        {t("base_map.epsg")}
        <input
          inputMode="numeric"
          pattern="[0-9]*"
          maxLength={6}
          placeholder="25832"
          onInput={(event) => (epsg.value = event.currentTarget.value.trim())}
        />
      </label>
      <button
        type="button"
        class="primary"
        disabled={image.value === null || world.value === null}
        onClick={() => void attempt(send())}
      >
        {t("base_map.set")}
      </button>
      {done.words}
      {baseMap.value !== null && (
        <ConfirmButton
          label={t("base_map.remove")}
          question={t("base_map.remove_question")}
          onConfirm={() => void attempt(removeBaseMap().then(() => (baseMap.value = null)))}
        />
      )}
    </div>
  );
}
