using KinefabUnity;
using UnityEngine;

/// <summary>Turns a freedom of a mechanism on the same object, as a motor would that nothing can stop but a limit.</summary>
public sealed class TurnCrank : MonoBehaviour
{
    /// <summary>As the mechanism's inspector calls it.</summary>
    public string freedom = "Motor";

    /// <summary>Degrees a second.</summary>
    public float speed = 90;

    private KinefabMechanism _mechanism;

    private void Start() => _mechanism = GetComponent<KinefabMechanism>();

    private void Update()
    {
        KinefabResult result = _mechanism.Drive(freedom, _mechanism.Value(freedom) + speed * Time.deltaTime);
        if (!result.Reached)
        {
            speed = -speed; // at a limit or a dead point it turns back
        }
    }
}
