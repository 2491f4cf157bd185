import { Component, type ComponentChildren } from "preact";
import { cannotShow } from "../live/faults";
import { Icon } from "./Icon";

interface Props {
  /** Name of the card, panel or dialog for users. */
  what: string;
  /** A list holds nothing but entries. */
  as?: "div" | "li";
  /** Receives the error in place of being shown here. */
  onFault?: (fault: string) => void;
  children: ComponentChildren;
}

/** Time until a failed part is drawn again: its data may have changed. */
const AGAIN_MS = 5_000;

/** A failing part is named on the screen in its place, and affects no other part. */
export class ErrorBoundary extends Component<Props, { fault: string | null }> {
  override state = { fault: null };
  private timer = 0;

  override componentDidCatch(error: unknown): void {
    console.error(error);
    const fault = cannotShow(this.props.what, error);
    this.setState({ fault });
    this.props.onFault?.(fault);
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.setState({ fault: null }), AGAIN_MS);
  }

  override componentWillUnmount(): void {
    clearTimeout(this.timer);
  }

  override render({ as: As = "div", onFault, children }: Props, { fault }: { fault: string | null }) {
    if (fault === null) return children;
    if (onFault !== undefined) return null;
    return (
      <As class="cannot-show" role="alert">
        <Icon name="alarm" />
        {fault}
      </As>
    );
  }
}
