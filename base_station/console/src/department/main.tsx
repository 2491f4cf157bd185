/** The page of a department: all stations that report to it. */
import { render } from "preact";
import "../styles/colours.css";
import "../styles/theme.css";
import "../styles/frame.css";
import "../styles/department.css";
import "../appearance";
import { useLanguage } from "../language/choices";
import { Department } from "./Department";
import { refresh } from "./reports";

await Promise.all([useLanguage(), refresh()]);
const root = document.getElementById("app");
if (root) render(<Department />, root);
