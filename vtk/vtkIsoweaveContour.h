// The simplified surface of an image at one value: isoweave as a filter of VTK.
//
// The whole image is meshed in place, and the mesh is that of isoweave::mesh_volume for the same samples and options.
// Errors are those of the pipeline (vtkErrorMacro), the output is empty then, and no exception leaves the filter.
#ifndef vtkIsoweaveContour_h
#define vtkIsoweaveContour_h

#include <vtkPolyDataAlgorithm.h>

#include <string>

class vtkIsoweaveContour : public vtkPolyDataAlgorithm {
 public:
  static vtkIsoweaveContour* New();
  vtkTypeMacro(vtkIsoweaveContour, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  // The value at the surface. SetInputArrayToProcess chooses the point array, which has one component; else it is the
  // active scalars.
  vtkSetMacro(Value, double);
  vtkGetMacro(Value, double);

  // How far the surface may move, typically (RMS): "0.2vox", or "0.05" in the unit of the image's spacing; "0": the
  // full surface.
  vtkSetStdStringFromCharMacro(Error);
  vtkGetCharFromStdStringMacro(Error);

  // Whether the surface is closed at the border of the image.
  vtkSetMacro(Closed, bool);
  vtkGetMacro(Closed, bool);
  vtkBooleanMacro(Closed, bool);

  // Whether points get normals: gradients of the samples, outwards. Zero where there is no direction.
  vtkSetMacro(ComputeNormals, bool);
  vtkGetMacro(ComputeNormals, bool);
  vtkBooleanMacro(ComputeNormals, bool);

  // The number of threads; 0: one for each processor. It never changes the mesh.
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);

  // The fingerprint of the last mesh, as `isoweave check` prints it; empty where there is none.
  vtkGetCharFromStdStringMacro(Digest);

  vtkIsoweaveContour(const vtkIsoweaveContour&) = delete;
  void operator=(const vtkIsoweaveContour&) = delete;

 protected:
  vtkIsoweaveContour();
  ~vtkIsoweaveContour() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

 private:
  double Value;
  std::string Error;
  bool Closed;
  bool ComputeNormals;
  int NumberOfThreads;
  std::string Digest;
};

#endif
