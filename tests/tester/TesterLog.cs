using UnityEngine;
using UnityEngine.SceneManagement;

/// <summary>Prints the answers to questions 1, 2, 5 and 6 of schemas/TESTER.md after a second; on any object of the scene.</summary>
public sealed class TesterLog : MonoBehaviour
{
    private const float Seconds = 1;
    private float _plain, _extended, _passed;
    private bool _isDone;

    private void FixedUpdate()
    {
        _passed += Time.fixedDeltaTime;
        foreach (GameObject root in SceneManager.GetActiveScene().GetRootGameObjects())
        {
            foreach (HingeJoint hinge in root.GetComponentsInChildren<HingeJoint>())
            {
                // The angle that Unity counts wraps; what the body has turned in a step does not.
                float turned = hinge.GetComponent<Rigidbody>().angularVelocity.magnitude * Mathf.Rad2Deg * Time.fixedDeltaTime;
                if (hinge.name == "Hinge plain")
                {
                    _plain += turned;
                }
                else if (hinge.name == "Hinge extended")
                {
                    _extended += turned;
                }
            }
        }

        if (_isDone || _passed < Seconds)
        {
            return;
        }

        _isDone = true;
        Debug.Log("Kinefab tester: Unity " + Application.unityVersion);
        foreach (GameObject root in SceneManager.GetActiveScene().GetRootGameObjects())
        {
            foreach (ArticulationBody link in root.GetComponentsInChildren<ArticulationBody>())
            {
                if (link.name == "Turning link")
                {
                    Debug.Log("1: asked for 90, turns by " + link.jointVelocity[0] * Mathf.Rad2Deg + " degrees a second");
                }
                else if (link.name == "Sliding link")
                {
                    Debug.Log("2: asked for 0.1 m/s, has gone " + link.jointPosition[0] + " m in " + _passed + " s");
                }
            }
        }

        Debug.Log("5: Hinge plain has turned by " + _plain + " degrees, Hinge extended by " + _extended);
#if UNITY_6000_2_OR_NEWER
        var physics = Physics.GetCurrentIntegrationInfo();
        Debug.Log("6: " + physics.name + ": " + physics.description);
#endif
    }
}
