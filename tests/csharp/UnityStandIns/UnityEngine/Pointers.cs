// The part of the Input System package that the dragger uses: KINEFAB_INPUT_SYSTEM stands for the package, as in the asmdef.
#if ENABLE_INPUT_SYSTEM && KINEFAB_INPUT_SYSTEM
namespace UnityEngine.InputSystem
{
    public sealed class Pointer
    {
        public static Pointer current { get; internal set; }

        public Controls.Vector2Control position { get; } = new Controls.Vector2Control();

        public Controls.ButtonControl press { get; } = new Controls.ButtonControl();
    }
}

namespace UnityEngine.InputSystem.Controls
{
    public sealed class Vector2Control
    {
        internal Vector2 Value;

        public Vector2 ReadValue() => Value;
    }

    public sealed class ButtonControl
    {
        public bool isPressed { get; internal set; }

        public bool wasPressedThisFrame { get; internal set; }
    }
}
#endif

// The part of the UGUI package that the dragger uses, likewise; what the pointer is on is set by the test.
#if KINEFAB_UGUI
namespace UnityEngine.EventSystems
{
    using System.Collections.Generic;

    public class EventSystem : MonoBehaviour
    {
        internal readonly List<RaycastResult> Hits = new List<RaycastResult>();

        public static EventSystem current { get; set; }

        public void RaycastAll(PointerEventData eventData, List<RaycastResult> raycastResults)
        {
            raycastResults.Clear();
            raycastResults.AddRange(Hits);
        }
    }

    public class PointerEventData
    {
        public PointerEventData(EventSystem eventSystem)
        {
        }

        public Vector2 position { get; set; }
    }

    public struct RaycastResult
    {
        public BaseRaycaster module;
    }

    public abstract class BaseRaycaster : MonoBehaviour
    {
    }

    public class PhysicsRaycaster : BaseRaycaster
    {
    }
}

namespace UnityEngine.UI
{
    public class GraphicRaycaster : EventSystems.BaseRaycaster
    {
    }
}
#endif
