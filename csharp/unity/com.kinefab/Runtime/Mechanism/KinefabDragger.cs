#if KINEFAB_UGUI
using System.Collections.Generic;
#endif
using UnityEngine;
#if KINEFAB_UGUI
using UnityEngine.EventSystems;
#endif
#if ENABLE_INPUT_SYSTEM && KINEFAB_INPUT_SYSTEM
using UnityEngine.InputSystem;
#endif

namespace KinefabUnity
{
    /// <summary>
    /// Lets the player pull at parts of every <see cref="KinefabMechanism"/> with the mouse: press on a part, move, release. Put it
    /// on any object, best on the camera. Works with the old Input Manager and with the Input System package; what is pressed through an
    /// interface that an EventSystem knows is the interface's.
    /// </summary>
    [AddComponentMenu("Kinefab/Kinefab Dragger")]
    public sealed class KinefabDragger : MonoBehaviour
    {
        /// <summary>Through which the player sees; empty: this object's own camera, else the main one.</summary>
        public Camera view;

        private readonly PartDrag _drag = new PartDrag();

        /// <summary>The part that is pulled; null: none.</summary>
        public Transform Part => _drag.Mechanism == null ? null : _drag.Part;

        private void Update()
        {
            Camera eye = view != null ? view : TryGetComponent(out Camera own) ? own : Camera.main;
            if (eye != null && ReadPointer(out Vector2 at, out bool isPressed, out bool isDown))
            {
                Pull(eye, at, isPressed, isDown);
            }
        }

        private void OnDisable() => _drag.End();

        private void Pull(Camera eye, Vector2 at, bool isPressed, bool isDown)
        {
            if (isPressed && IsOnInterface(at))
            {
                _drag.End();
            }
            else if (isPressed)
            {
                _drag.Begin(eye.ScreenPointToRay(at), eye.transform.forward);
            }
            else if (_drag.Mechanism != null && isDown)
            {
                _drag.Move(eye.ScreenPointToRay(at));
            }
            else if (_drag.Mechanism != null)
            {
                _drag.End();
            }
        }

        // By the place and not by IsPointerOverGameObject, which asks for a finger's number, and which a raycaster for the scene's own parts answers too.
        private static bool IsOnInterface(Vector2 at)
        {
#if KINEFAB_UGUI
            EventSystem events = EventSystem.current;
            if (events == null)
            {
                return false;
            }

            var hits = new List<RaycastResult>();
            events.RaycastAll(new PointerEventData(events) { position = at }, hits);
            return hits.Exists(hit => !(hit.module is PhysicsRaycaster));
#else
            return false;
#endif
        }

        private static bool ReadPointer(out Vector2 at, out bool isPressed, out bool isDown)
        {
#if ENABLE_INPUT_SYSTEM && KINEFAB_INPUT_SYSTEM
            Pointer pointer = Pointer.current;
            if (pointer == null)
            {
                at = default;
                isPressed = isDown = false;
                return false;
            }

            at = pointer.position.ReadValue();
            isPressed = pointer.press.wasPressedThisFrame;
            isDown = pointer.press.isPressed;
            return true;
#elif ENABLE_LEGACY_INPUT_MANAGER
            Vector3 mouse = Input.mousePosition;
            at = new Vector2(mouse.x, mouse.y);
            isPressed = Input.GetMouseButtonDown(0);
            isDown = Input.GetMouseButton(0);
            return true;
#else
            at = default;
            isPressed = isDown = false;
            return false;
#endif
        }
    }
}
